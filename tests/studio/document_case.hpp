#pragma once

#include <weave/samples/samples.hpp>

#include <studio/commands/flip_crossing.hpp>
#include <studio/document/document.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <memory>

namespace weave::studio::test {

inline Design sample(const char* name) {
    return find_sample(name)->make();
}

/// Waits until the block that is shown is of the design as it stands.
inline void settle(const Document& document) {
    REQUIRE(QTest::qWaitFor([&] { return document.shown_is_current(); }, 20000));
}

/// A design of two satins that merge in nothing but the list.
inline Design small_design() {
    Design design;
    design.root = "face";
    design.blocks["face"] = std::make_shared<const Node>(Node{PresetLeaf{{"twill", {{"up", 1}, {"down", 4}}}}, {}});
    return design;
}

inline void flip_at(Document& document, std::size_t pick, std::size_t end) {
    auto step = flip_crossing(document, {pick, end});
    REQUIRE(step);
    REQUIRE(document.perform(*step));
}

}  // namespace weave::studio::test
