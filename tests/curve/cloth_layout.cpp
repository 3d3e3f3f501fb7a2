// Key points that are asked for stretch by stretch, and turns that are cleared strip by strip, are those of the cloth as a whole.

#include "curve/random_cloth.hpp"
#include "support/random.hpp"

#include <weave/curve/cloth_layout.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave;
using namespace weave::testing;

namespace {

void check_same(const std::vector<KeyPoint>& found, const std::vector<KeyPoint>& wanted, std::size_t first) {
    for (std::size_t k = 0; k < found.size(); ++k) {
        const KeyPoint &a = found[k], &b = wanted[first + k];
        REQUIRE((a.place == b.place && a.row == b.row && a.column == b.column && a.yarn == b.yarn && a.loose == b.loose));
    }
}

void check_same(const ClothCurves& found, const ClothCurves& wanted) {
    REQUIRE(found.yarns.size() == wanted.yarns.size());
    for (std::size_t y = 0; y < found.yarns.size(); ++y) {
        REQUIRE(found.yarns[y].keys.size() == wanted.yarns[y].keys.size());
        check_same(found.yarns[y].keys, wanted.yarns[y].keys, 0);
    }
    REQUIRE(found.crossings.size() == wanted.crossings.size());
}

std::optional<Region> some_region(Random& random, const Block& block) {
    if (random.coin()) return {};
    Region region;
    region.first_row = random.between(0, block.rows() - 1);
    region.last_row = random.between(region.first_row, block.rows() - 1);
    region.first_column = random.between(0, block.columns() - 1);
    region.last_column = random.between(region.first_column, block.columns() - 1);
    return region;
}

}  // namespace

TEST_CASE("Any stretch of a yarn has the key points of the whole") {
    for_all(
        [](Random& random) {
            const Block block = random_block(random, {}, {}, 7);
            const Design design = random_plan(random);
            const CurveOptions options{some_region(random, block), random.coin() ? WeftMode::periodic : WeftMode::wraparound};
            const auto layout = ClothLayout::make(design, block, options);
            REQUIRE(layout);
            const ClothCurves whole = all_curves(*layout);
            for (std::size_t yarn = 0; yarn < whole.yarns.size(); ++yarn) {
                REQUIRE(layout->keys(yarn) == whole.yarns[yarn].keys.size());
                const std::size_t first = random.between(0, layout->keys(yarn)), last = random.between(first, layout->keys(yarn));
                std::vector<KeyPoint> keys;
                layout->add_keys(yarn, first, last, keys);
                REQUIRE(keys.size() == last - first);
                check_same(keys, whole.yarns[yarn].keys, first);
            }
        },
        property_cases() / 5);
}

TEST_CASE("Key points are foreseen as they are laid, but for those of yarns that are loose all along") {
    for_all(
        [](Random& random) {
            const Block block = random_block(random, {}, {}, 7);
            const Design design = random_plan(random);
            const CurveOptions options{some_region(random, block), WeftMode::periodic};  // turns may be led further aside later
            const auto curves = cloth_curves(design, block, options);
            const auto foreseen = ClothLayout::foreseen(design, block, options);
            REQUIRE(bool(foreseen) == bool(curves));
            if (!curves) return;
            std::size_t laid = 0;
            for (const YarnCurve& yarn : curves->yarns) laid += std::ranges::all_of(yarn.keys, &KeyPoint::loose) ? 0 : yarn.keys.size();
            REQUIRE(foreseen->segments + foreseen->open_yarns == laid);
        },
        property_cases() / 5);
}

TEST_CASE("Turns that are cleared strip by strip lie as where all are looked at together") {
    for_all(
        [&](Random& random) {
            std::vector<std::uint32_t> t(random.between(30, 90)), p(random.between(1, 4));
            for (auto& count : t) count = static_cast<std::uint32_t>(random.between(1, 3));
            for (auto& count : p) count = static_cast<std::uint32_t>(random.between(1, 3));
            const Block block = random_block(random, t, p);
            const Design design = random_plan(random);
            const CurveOptions options{some_region(random, block), WeftMode::wraparound};
            const auto whole = ClothLayout::make(design, block, options, SIZE_MAX), strips = ClothLayout::make(design, block, options, 150);
            REQUIRE(whole);
            REQUIRE(strips);
            check_same(all_curves(*strips), all_curves(*whole));
        },
        property_cases() / 20);
}
