#pragma once

// A small design on a small loom, to be spoilt in one place by each test of validation.

#include <weave/loom/check.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace weave::testing {

/// One end a column; in each stack the picks that pass under the end, the end, the picks that pass over it.
inline BlockPtr block_of(const std::vector<std::string>& rows, std::uint32_t t = 1) {
    const auto stack = [&](std::size_t row, std::size_t column) {
        std::vector<Slot> slots;
        for (const char wanted : {'0', '1'}) {
            if (wanted == '1') slots.push_back(Slot::warp(0));
            for (std::size_t k = 0; k < t; ++k) {
                if (rows[row * t + k][column] == wanted) slots.push_back(Slot::weft(k));
            }
        }
        return Stack(std::move(slots));
    };
    std::vector<std::uint32_t> picks(rows.size() / t, t), ends(rows.front().size(), 1);
    return std::make_shared<const Block>(make_block(std::move(picks), std::move(ends), stack).value());
}

inline LoomProfile loom() {
    LoomProfile profile;
    profile.name = "test";
    profile.total_hooks = 40;
    profile.body = {{0, 31}};
    profile.selvedge = {{32, 35}};
    profile.selvedge_weave = {"01", "10"};
    profile.regulator_hooks = {39};
    profile.limits = {3, 3, 0.5, 0.8, 100, 0.02, 50.0};
    profile.density_ends_per_cm = 20;
    return profile;
}

inline const std::vector<std::string> plain{"0101", "1010", "0101", "1010"};

struct Case {
    Design design;
    LoomProfile profile = loom();
    Evaluation cloth{block_of(plain), {}};
    std::optional<RelaxedCloth> relaxed;

    [[nodiscard]] std::vector<Finding> of(const std::string& rule) const {
        std::vector<Finding> found;
        for (const Finding& f : check_for_loom(design, cloth, profile, relaxed).findings) {
            if (f.rule == rule) found.push_back(f);
        }
        return found;
    }
    [[nodiscard]] bool passes(const std::string& rule) const {
        const auto passed = check_for_loom(design, cloth, profile, relaxed).passed;
        return std::find(passed.begin(), passed.end(), rule) != passed.end();
    }
    [[nodiscard]] bool lacks(const std::string& rule) const {
        const auto missing = check_for_loom(design, cloth, profile, relaxed).not_evaluated;
        return std::any_of(missing.begin(), missing.end(),
                           [&](const auto& n) { return n.rule == rule && !n.reason.empty(); });
    }
    void expect_at(const std::string& rule, std::optional<std::size_t> pick,
                   std::optional<std::size_t> end) const {
        INFO(rule);
        const auto found = of(rule);
        REQUIRE(!found.empty());
        CHECK(found[0].pick == pick);
        CHECK(found[0].end == end);
        CHECK_FALSE(found[0].message.empty());
        CHECK_FALSE(passes(rule));
    }
};

}  // namespace weave::testing
