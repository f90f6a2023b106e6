// Replays what fuzzing found worth keeping, reproducers of faults among it, in every build.
#include "fuzz/fuzz_targets.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace pcl_floam::test {
namespace {

struct Corpus {
  const char* folder;
  FuzzTarget target;
};

void PrintTo(const Corpus& corpus, std::ostream* out)
{
  *out << corpus.folder;
}

class FuzzCorpus : public ::testing::TestWithParam<Corpus> {};

TEST_P(FuzzCorpus, BreaksNoLaw)
{
  const std::filesystem::path folder = std::filesystem::path(PCL_FLOAM_FUZZ_CORPUS) / GetParam().folder;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    const std::string content = contentOf(entry.path());
    EXPECT_NO_THROW(GetParam().target(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
    ++files;
  }
  EXPECT_GT(files, 3U);
}

std::vector<Corpus> corpora()
{
  std::vector<Corpus> all = {{"pcd", fuzzPcd},
                             {"kitti_bin", fuzzKittiBin},
                             {"poses", fuzzPoses},
                             {"times", fuzzTimes},
                             {"map", fuzzMap},
                             {"recording", fuzzRecording},
                             {"scan_message", fuzzScanMessage},
                             {"calibration", fuzzCalibration}};
#ifdef PCL_FLOAM_WITH_TOOLS
  all.push_back({"odometry_options", fuzzOdometryOptions});
#endif
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, FuzzCorpus, ::testing::ValuesIn(corpora()),
                         [](const auto& parameter) { return std::string(parameter.param.folder); });

}  // namespace
}  // namespace pcl_floam::test
