#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/passing.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace weave;

namespace {

const LineSpacing spacing{false, 0.5, 0.3, 0.3, 0.125};

/// The curves that leads make in a line along y.
ClothCurves curves_of(const std::vector<Lead>& leads) {
    ClothCurves curves;
    for (const Lead& lead : leads) {
        YarnCurve yarn;
        for (std::size_t k = 0; k < lead.level.size(); ++k) {
            KeyPoint key;
            key.place = {lead.aside_mm[k],
                         spacing.along_mm * static_cast<double>(k) / static_cast<double>(lead.keys),
                         lead.level[k] * spacing.level_mm};
            yarn.keys.push_back(key);
        }
        curves.yarns.push_back(yarn);
    }
    return curves;
}

std::vector<Lead> ways(const std::vector<LineYarn>& yarns, const LineSpacing& with, std::size_t effort = 0) {
    return leads_along(yarns, with, find_way(yarns, with, effort));
}

}  // namespace

TEST_CASE("Yarns that change places right beside a stack are kept apart by a level way through it") {
    const std::vector<LineYarn> yarns = {{0, {0, 0, 4, 4}}, {0, {0.1, 0.1, -4, -4}}};
    const std::vector<Lead> leads = ways(yarns, spacing);
    // In the stack a tenth of a level, 0.03 mm, is between them; they pass at a tenth of 0.25 mm or more.
    CHECK_FALSE(first_meeting(curves_of(leads), 0.02));
    for (std::size_t a = 0; a < yarns.size(); ++a) {
        const Lead& lead = leads[a];
        REQUIRE(lead.level.size() == 3 * lead.keys + 1);
        for (std::size_t s = 0; s < 4; ++s) {
            CHECK(lead.level[s * lead.keys] == yarns[a].levels[s]);
            CHECK(lead.aside_mm[s * lead.keys] == 0);
        }
    }
}

TEST_CASE("At the most effort a yarn runs level in its stacks, even where none passes it") {
    const std::vector<LineYarn> yarns = {{0, {0, 2}}};
    CHECK(ways(yarns, spacing)[0].keys == 1);
    CHECK(ways(yarns, spacing, most_effort - 1)[0].keys == 1);
    const Lead lead = ways(yarns, spacing, most_effort)[0];
    REQUIRE(lead.keys == 8);
    for (std::size_t k = 0; k <= 8; ++k) {
        CHECK(lead.level[k] == Approx(1 - std::cos(std::numbers::pi * static_cast<double>(k) / 8)).margin(1e-12));
        CHECK(lead.aside_mm[k] == 0);
    }
}
