// scans.csv: what the odometry says of each scan.

#include "tools/odometry_tool_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace pcl_floam {
namespace {

using test::contentOf;
using test::OdometryTool;

constexpr std::size_t kColumns = 13;

/// Lines cut at commas; a reason may hold some itself and is left whole.
std::vector<std::vector<std::string>> cells(const std::string& content)
{
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(content);
  for (std::string line; std::getline(text, line);) {
    std::vector<std::string> row;
    std::istringstream words(line);
    std::string word;
    while (row.size() + 1 < kColumns && std::getline(words, word, ',')) {
      row.push_back(word);
    }
    std::getline(words, word);
    row.push_back(word);
    rows.push_back(row);
  }
  return rows;
}

class ScanResults : public OdometryTool {
protected:
  [[nodiscard]] std::vector<std::vector<std::string>> rows() const
  {
    std::vector<std::vector<std::string>> all = cells(contentOf(folder.path() / "result" / "scans.csv"));
    EXPECT_EQ(all.front().front(), "scan");
    EXPECT_EQ(all.front().back(), "reason");
    all.erase(all.begin());
    for (const std::vector<std::string>& row : all) {
      EXPECT_EQ(row.size(), kColumns);
    }
    return all;
  }
};

TEST_F(ScanResults, EveryPoseHasItsRow)
{
  folder.write("scans/3.bin", "not a scan");
  ASSERT_EQ(odometry("scans -o result --from 1 --plot none").status, 1);
  const auto scans = rows();
  ASSERT_EQ(scans.size(), poses().size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i][0], std::to_string(i + 1));
    EXPECT_EQ(scans[i][1], i == 0 ? "initialized" : i == 2 ? "predicted" : "tracked") << i;
    EXPECT_EQ(scans[i].back() == "\"\"", i != 2) << i << ": " << scans[i].back();
  }
}

TEST_F(ScanResults, ATrackedScanIsBorneOutByTheMapAndHasACovariance)
{
  ASSERT_EQ(odometry("scans -o result --timing none --start-effort 1000 --plot none").status, 0);
  const auto scans = rows();
  const std::vector<std::string>& last = scans.back();
  EXPECT_EQ(last[2], "0");
  EXPECT_GT(std::stod(last[3]), 0.5);
  EXPECT_LE(std::stod(last[3]), 1.0);
  EXPECT_GT(std::stod(last[4]), 0.0);
  EXPECT_LT(std::stod(last[4]), 0.012);
  EXPECT_EQ(last[5], "0");
  const std::size_t diagonal[] = {6, 9, 11};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double sigma = summary()["last_scan"]["position_sigma_m"][axis];
    EXPECT_NEAR(std::sqrt(std::stod(last[diagonal[axis]])), sigma, 1e-6 * sigma);
  }
}

TEST_F(ScanResults, WhileTimesAreNotFoundOutPosesAreProvisional)
{
  const test::Outcome outcome = odometry("scans -o result --plot none");
  ASSERT_EQ(outcome.status, 0);
  const auto scans = rows();
  EXPECT_EQ(scans.front()[2], "0");
  EXPECT_TRUE(std::all_of(scans.begin() + 1, scans.end(), [](const auto& row) { return row[2] == "1"; }));
  EXPECT_EQ(summary()["scans"]["provisional"], kScans - 1);
  EXPECT_NE(outcome.out.find("7 provisional"), std::string::npos) << outcome.out;
  ASSERT_EQ(odometry("scans -o result --timing none --start-effort 1000 --plot none").status, 0);
  EXPECT_EQ(summary()["scans"]["provisional"], 0);
}

TEST_F(ScanResults, WeakDirectionsAreCountedPerScan)
{
  for (std::size_t i = 0; i < kScans; ++i) {
    folder.write("floor/" + std::to_string(i) + ".bin", test::floorScan());
  }
  ASSERT_EQ(odometry("floor -o result --engine features --plot none").status, 1);
  std::size_t with_weak_directions = 0;
  for (const auto& row : rows()) {
    with_weak_directions += row[5] == "0" ? 0 : 1;
  }
  EXPECT_GT(with_weak_directions, kScans / 2);
  EXPECT_EQ(summary()["scans"]["with_weak_directions"], with_weak_directions);
}

}  // namespace
}  // namespace pcl_floam
