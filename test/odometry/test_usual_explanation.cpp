// Whether a map explains as much of a sweep as it usually does.
#include "odometry/usual_explanation.h"

#include <gtest/gtest.h>

namespace pcl_floam {
namespace {

UsualExplanation after(int sweeps, double explained)
{
  UsualExplanation explanation;
  for (int i = 0; i < sweeps; ++i) {
    explanation.takeUnjudged(explained);
  }
  return explanation;
}

TEST(UsualExplanation, IsTheScenes)
{
  for (const double usual : {0.3, 0.9}) {
    UsualExplanation explanation = after(20, usual);
    explanation.take(0.6 * usual);
    EXPECT_TRUE(explanation.bearsOut()) << usual;
    explanation.take(0.4 * usual);
    EXPECT_FALSE(explanation.bearsOut()) << usual;
  }
}

/// Or what is not explained would become what is usual.
TEST(UsualExplanation, IsNotOfWhatIsNotBorneOut)
{
  UsualExplanation explanation = after(20, 0.8);
  for (int i = 0; i < 20; ++i) {
    explanation.take(0.3);
    EXPECT_FALSE(explanation.bearsOut()) << i;
  }
  EXPECT_FALSE(explanation.isMet(0.3));
  EXPECT_TRUE(explanation.isMet(0.5));
}

/// A hand that covers the sensor for a second does not bring what it shows into the map; a sensor that was carried
/// elsewhere goes on there within ten.
TEST(UsualExplanation, IsNotAskedForEver)
{
  constexpr int kSecond = 10;  // scans
  UsualExplanation explanation = after(20, 0.8);
  for (int i = 0; i < kSecond; ++i) {
    explanation.take(0.1);
    EXPECT_FALSE(explanation.bearsOut()) << i;
  }
  for (int i = kSecond; i < 10 * kSecond; ++i) {
    explanation.take(0.1);
  }
  EXPECT_TRUE(explanation.bearsOut());
}

TEST(UsualExplanation, OfAPriorMapIsHalfOfASweepAtFirst)
{
  UsualExplanation explanation = UsualExplanation::ofPriorMap();
  for (int i = 0; i < 100; ++i) {
    explanation.take(0.45);
    EXPECT_FALSE(explanation.bearsOut()) << i;
  }
  explanation.take(0.55);
  EXPECT_TRUE(explanation.bearsOut());
  explanation.take(0.45);
  EXPECT_TRUE(explanation.bearsOut()) << "as usual there";
}

}  // namespace
}  // namespace pcl_floam
