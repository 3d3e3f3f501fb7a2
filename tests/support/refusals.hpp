#pragma once

#include <catch2/catch.hpp>

#include <string>

namespace weave::testing {

/// A refusal that says `words`.
template <class Outcome>
void check_refused(const Outcome& outcome, const std::string& words) {
    REQUIRE_FALSE(outcome);
    CHECK_THAT(outcome.error().text(), Catch::Contains(words));
}

}  // namespace weave::testing
