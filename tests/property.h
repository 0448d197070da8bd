#pragma once
// Properties on random cases (rapidcheck) that are the same cases in every run.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <sstream>
#include <string>

namespace wale::test {

/// Fails the current test unless `property` holds in `cases` random cases, after shrinking the one that broke it. The
/// seed is fixed: what passes today passes tomorrow.
template <typename Property>
void check_property(int cases, Property&& property) {
  rc::detail::TestMetadata about;
  about.description = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  rc::detail::TestParams params;
  params.seed = 20210607;
  params.maxSuccess = cases;
  const auto result =
      rc::detail::checkProperty(rc::detail::toProperty(std::forward<Property>(property)), about, params);
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  EXPECT_TRUE(result.template is<rc::detail::SuccessResult>()) << text.str();
}

/// A number from `low` to `high` that shrinks towards `low`.
inline rc::Gen<double> number_between(double low, double high) {
  constexpr int kSteps = 1000000;
  return rc::gen::map(rc::gen::inRange(0, kSteps + 1), [=](int i) { return low + (high - low) * i / kSteps; });
}

}  // namespace wale::test
