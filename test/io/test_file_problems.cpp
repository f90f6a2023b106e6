// Files and folders that the system refuses: without rights, on a full disk.
#include "support/temporary_folder.h"
#include "support/without_rights.h"

#include <pcl_floam/io/map_io.h>
#include <pcl_floam/io/scan_source.h>
#include <pcl_floam/io/trajectory.h>

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::TemporaryFolder;
using test::thrownWithoutRights;
namespace fs = std::filesystem;

/// A folder that everyone may enter, with things in it that nobody may.
class WithoutRights : public ::testing::Test {
protected:
  WithoutRights() { fs::permissions(folder.path(), fs::perms(0755)); }
  ~WithoutRights() override
  {
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      fs::permissions(entry.path(), fs::perms(0755));
    }
  }
  WithoutRights(const WithoutRights&) = delete;
  WithoutRights& operator=(const WithoutRights&) = delete;

  static void expectDenied(const std::string& message, const fs::path& path)
  {
    EXPECT_EQ(message.rfind(path.string() + ": ", 0), 0U) << message;
    EXPECT_NE(message.find("Permission denied"), std::string::npos) << message;
  }

  TemporaryFolder folder;
};

TEST_F(WithoutRights, AFolderThatMayNotBeListedIsToldFromAnEmptyOne)
{
  folder.write("scans/0.bin", std::string(16, '\0'));
  fs::permissions(folder.path() / "scans", fs::perms(0));
  expectDenied(thrownWithoutRights([&] { ScanSource(folder.path() / "scans"); }), folder.path() / "scans");
}

TEST_F(WithoutRights, AFolderThatCannotBeReachedIsToldFromAMissingOne)
{
  folder.write("closed/scans/0.bin", std::string(16, '\0'));
  fs::permissions(folder.path() / "closed", fs::perms(0));
  expectDenied(thrownWithoutRights([&] { ScanSource(folder.path() / "closed/scans"); }),
               folder.path() / "closed/scans");
}

TEST_F(WithoutRights, FilesThatMayNotBeReadAreErrorsWithThatReason)
{
  const fs::path file = folder.write("0.bin", std::string(16, '\0'));
  fs::permissions(file, fs::perms(0));
  expectDenied(thrownWithoutRights([&] {
                 pcl::PCLPointCloud2 cloud;
                 readKittiBin(file, cloud);
               }),
               file);
  expectDenied(thrownWithoutRights([&] { (void)readTrajectory(file); }), file);
}

TEST_F(WithoutRights, FoldersThatMayNotBeWrittenToAreErrorsWithThatReason)
{
  fs::create_directory(folder.path() / "results");
  fs::permissions(folder.path() / "results", fs::perms(0555));
  const fs::path poses = folder.path() / "results/poses.txt";
  expectDenied(thrownWithoutRights([&] { TrajectoryWriter(poses, TrajectoryFormat::tum); }), poses);
  expectDenied(thrownWithoutRights([&] { saveMap(KeyframeVoxelMap(), folder.path() / "results"); }),
               folder.path() / "results" / kMapEdgesFile);
  expectDenied(thrownWithoutRights([&] { saveMap(KeyframeVoxelMap(), folder.path() / "results/new"); }),
               folder.path() / "results/new");
}

class FullDisk : public ::testing::Test {
protected:
  void SetUp() override
  {
    if (!fs::exists("/dev/full")) {
      GTEST_SKIP() << "no /dev/full here";
    }
  }

  static void expectFull(const std::string& message, const fs::path& path)
  {
    EXPECT_EQ(message, path.string() + ": cannot be written: No space left on device");
  }

  TemporaryFolder folder;
};

TEST_F(FullDisk, ATrajectoryThatDoesNotFitIsAnErrorAtThePoseConcerned)
{
  const fs::path file = folder.path() / "poses.txt";
  fs::create_symlink("/dev/full", file);
  TrajectoryWriter writer(file, TrajectoryFormat::kitti);
  try {
    writer.write({});
    ADD_FAILURE() << "written to a full disk";
  } catch (const FileError& error) {
    expectFull(error.what(), file);
  }
}

TEST_F(FullDisk, AMapThatDoesNotFitLeavesTheFormerOne)
{
  KeyframeVoxelMap map;
  map.insertPoints(FeatureKind::edge, {{1.0, 2.0, 3.0}});
  map.insertPoints(FeatureKind::plane, {{4.0, 5.0, 6.0}, {7.0, 8.0, 9.0}});
  saveMap(map, folder.path());
  const std::string before = contentOf(folder.path() / kMapPlanesFile);
  fs::create_symlink("/dev/full", folder.path() / (std::string(kMapPlanesFile) + ".part"));
  map.insertPoints(FeatureKind::plane, {{10.0, 11.0, 12.0}});
  try {
    saveMap(map, folder.path());
    ADD_FAILURE() << "written to a full disk";
  } catch (const FileError& error) {
    expectFull(error.what(), folder.path() / kMapPlanesFile);
  }
  EXPECT_EQ(contentOf(folder.path() / kMapPlanesFile), before);
  EXPECT_FALSE(fs::exists(folder.path() / (std::string(kMapPlanesFile) + ".part")));
  EXPECT_EQ(loadMap(folder.path()).size(FeatureKind::plane), 2U);
}

}  // namespace
}  // namespace pcl_floam
