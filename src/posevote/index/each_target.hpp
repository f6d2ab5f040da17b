// For tests: runs code with every instruction set.
#pragma once

#include <gtest/gtest.h>
#ifdef POSEVOTE_WITH_HIGHWAY
#include <hwy/targets.h>
#endif

namespace posevote {

/// Runs `test` once with each instruction set that this build and this CPU have.
template <class Test>
void for_each_target(const Test& test) {
#ifdef POSEVOTE_WITH_HIGHWAY
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    test();
    hwy::SetSupportedTargetsForTest(0);
  }
#else
  test();
#endif
}

}  // namespace posevote
