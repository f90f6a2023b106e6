// Bags of ROS 1 as our own test writes them.
#include "io/recordings/recordings_fixture.h"

#include <gtest/gtest.h>

#include <string>

namespace pcl_floam::test {
namespace {

class Bags : public Recordings {
protected:
  static std::string connection()
  {
    return bagRecord(7, bagField("conn", bytesOf(std::uint32_t{0})) + bagField("topic", "/points"),
                     bagField("topic", "/points") + bagField("type", "sensor_msgs/PointCloud2"));
  }
  static std::string message()
  {
    return bagRecord(2, bagField("conn", bytesOf(std::uint32_t{0})) + bagField("time", bytesOf(std::uint64_t{5})),
                     pointCloud2({}, MessageBytes(false)));
  }
  static std::string bag(const std::string& records, std::uint64_t index, std::uint32_t chunks,
                         const std::string& more = "")
  {
    std::string infos;
    for (std::uint32_t i = 0; index != 0 && i < chunks; ++i) {
      infos += bagRecord(6, bagField("ver", bytesOf(std::uint32_t{1})), "");
    }
    return "#ROSBAG V2.0\n" +
           bagRecord(3,
                     bagField("index_pos", bytesOf(index)) + bagField("conn_count", bytesOf(std::uint32_t{1})) +
                         bagField("chunk_count", bytesOf(chunks)) + more,
                     "") +
           records + infos;
  }
  static std::string chunk(const std::string& records, const std::string& compression = "none", int longer = 0)
  {
    return bagRecord(
        5,
        bagField("compression", compression) +
            bagField("size", bytesOf(static_cast<std::uint32_t>(static_cast<int>(records.size()) + longer))),
        records);
  }
  static std::string index(std::uint32_t offset)
  {
    return bagRecord(4,
                     bagField("ver", bytesOf(std::uint32_t{1})) + bagField("conn", bytesOf(std::uint32_t{0})) +
                         bagField("count", bytesOf(std::uint32_t{1})),
                     bytesOf(std::uint64_t{5}) + bytesOf(offset));
  }
  const std::string records = connection() + message();
  const std::string indexed = chunk(records) + index(static_cast<std::uint32_t>(connection().size()));
};

TEST_F(Bags, WithAndWithoutIndexGiveTheSame)
{
  EXPECT_EQ(problem(bag(indexed + connection(), 1, 1)), "");
  EXPECT_EQ(problem(bag(chunk(records), 1, 1)), "");
  const ScanSource scans(folder.write("0.bag", bag(indexed, 0, 0)));
  ASSERT_EQ(scans.size(), 2U) << "one scan, and the missing index";
  pcl::PCLPointCloud2 cloud;
  scans.read(0, cloud);
  expectSixNumbers(cloud);
  expectProblem(bag(indexed, 0, 0), "the bag has no index");
}

TEST_F(Bags, AFolderOfTheirPartsIsOneRecording)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  folder.write("parts/drive_9.bag", whole);
  folder.write("parts/drive_10.bag", whole);
  const ScanSource scans(folder.path() / "parts");
  EXPECT_EQ(scans.format(), ScanFormat::rosbag1);
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans.path(0).filename(), "drive_9.bag");
  EXPECT_EQ(scans.path(1).filename(), "drive_10.bag");
  folder.write("parts/drive_9.orig.bag", whole);
  EXPECT_EQ(ScanSource(folder.path() / "parts").size(), 2U) << "what reindexing leaves";
  folder.write("parts/0.bin", std::string(16, 'x'));
  EXPECT_EQ(ScanSource(folder.path() / "parts").format(), ScanFormat::kitti_bin) << "taken out of the bag";
}

TEST_F(Bags, AChunkThatIsNotAsItsHeaderSaysIsTold)
{
  expectProblem(bag(chunk(records, "none", 1), 1, 1), "it should be of");
  expectProblem(bag(indexed, 1, 2), "has 1 chunks and an index of 2");
  expectProblem(bag(chunk(records) + index(0) + connection(), 1, 1), "the index does not tell this message");
  const auto first = static_cast<std::uint32_t>(connection().size());
  expectProblem(bag(chunk(records + message()) + index(first) + connection(), 1, 1),
                "the index does not tell this message");
  expectProblem(bag(chunk(connection()) + index(first) + connection(), 1, 1), "a message that is not there");
}

TEST_F(Bags, UnknownCompressionAndEncryptionAreToldByName)
{
  expectProblem(bag(chunk(records, "lzma"), 1, 1), "compression 'lzma' is not known");
  expectProblem(bag(indexed, 1, 1, bagField("encryptor", "rosbag/AesCbcEncryptor")), "is encrypted (rosbag/Aes");
  expectProblem("#ROSBAG V1.2\n", "another version than 2.0");
}

TEST_F(Bags, ABagCutAnywhereIsTold)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  ASSERT_EQ(problem(whole), "");
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += 2) {
    EXPECT_NE(problem(whole.substr(0, bytes)), "") << bytes;
  }
}

TEST_F(Bags, AnyByteMayBeAnythingAndNothingIsReadBeyond)
{
  const std::string whole = bag(indexed + connection(), 1, 1);
  for (std::size_t at = 0; at < whole.size(); at += 2) {
    for (const char value : {'\0', '\xFF'}) {
      std::string changed = whole;
      changed[at] = value;
      EXPECT_NO_THROW((void)problem(changed)) << at;
    }
  }
}

}  // namespace
}  // namespace pcl_floam::test
