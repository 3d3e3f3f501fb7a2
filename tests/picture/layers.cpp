// The layers view: which yarns go together, and what the picture says of it.

#include <weave/picture/layer_map.hpp>

#include <functional>
#include <limits>
#include <picture/pictures.hpp>
#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

constexpr LayerPixel none = LayerPixel::none, lifted = LayerPixel::lifted, over = LayerPixel::weft_over,
                     between = LayerPixel::between;

std::vector<LayerPixel> pixels(const char* stack) {
    return layer_pixels(parse_stack(stack).value());
}

/// Every way to hand `many` yarns in their order to `few`, none of which gets nothing: owner of each.
void every_pairing(std::size_t many, std::size_t few, std::vector<std::size_t>& owner,
                   const std::function<void()>& found) {
    if (owner.size() == many) {
        if (owner.back() + 1 == few) found();
        return;
    }
    const std::size_t low = owner.empty() ? 0 : owner.back(), high = owner.empty() ? 0 : owner.back() + 1;
    for (std::size_t k = low; k <= std::min(high, few - 1); ++k) {
        owner.push_back(k);
        every_pairing(many, few, owner, found);
        owner.pop_back();
    }
}

/// By trying every pairing.
std::vector<LayerPixel> tried_out(const Stack& stack) {
    std::vector<std::ptrdiff_t> wefts, warps;
    std::vector<std::size_t> layer;
    std::size_t above = stack.wefts();
    for (std::size_t k = 0; k < stack.height(); ++k) {
        const Slot slot = stack.slots()[k];
        above -= slot.is_weft() ? 1 : 0;
        if (slot.is_loose() || slot.is_empty()) continue;
        (slot.is_weft() ? wefts : warps).push_back(static_cast<std::ptrdiff_t>(k));
        if (slot.is_weft()) layer.push_back(above);
    }
    std::vector<LayerPixel> result(stack.wefts(), none);
    if (wefts.empty() || warps.empty()) return result;
    const bool more_wefts = wefts.size() >= warps.size();
    const auto& many = more_wefts ? wefts : warps;
    const auto& few = more_wefts ? warps : wefts;
    std::ptrdiff_t best = std::numeric_limits<std::ptrdiff_t>::max();
    std::vector<std::pair<bool, bool>> sides;  // ends below, ends above
    std::vector<std::size_t> owner;
    every_pairing(many.size(), few.size(), owner, [&] {
        std::ptrdiff_t sum = 0;
        for (std::size_t a = 0; a < many.size(); ++a) sum += std::abs(many[a] - few[owner[a]]);
        if (sum > best) return;
        if (sum < best) sides.assign(wefts.size(), {false, false});
        best = sum;
        for (std::size_t a = 0; a < many.size(); ++a) {
            const std::size_t weft = more_wefts ? a : owner[a], warp = more_wefts ? owner[a] : a;
            (wefts[weft] > warps[warp] ? sides[weft].first : sides[weft].second) = true;
        }
    });
    for (std::size_t k = 0; k < wefts.size(); ++k)
        result[layer[k]] = sides[k].first && sides[k].second ? between : sides[k].first ? over : lifted;
    return result;
}

}  // namespace

TEST_CASE("the layers of a stack are its wefts from the top, each with the ends nearest in height") {
    CHECK(pixels("T0 P0 P1 T1") == std::vector{over, lifted});
    CHECK(pixels("T0 P0") == std::vector{lifted});
    // One warp through three wefts meets each of them.
    CHECK(pixels("T0 P0 T1 T2") == std::vector{over, over, lifted});
    // A stack of TL013: two plain weaves at the bottom, two at the top, a zigzag end in between.
    CHECK(pixels("P5 T0 T1 P6 T2 T3 T4 P7 P8 P9 T5") != std::vector(6, lifted));
    CHECK(pixels("T0 P0 P1 T1 T2 P2") == std::vector{lifted, over, lifted});
    // As many ends above as below: no side is the truth.
    CHECK(pixels("P0 T0 P1") == std::vector{between});
    // What is loose goes with nothing, but a loose weft keeps its place.
    CHECK(pixels("T0 P0 T1~ P1~ T2 P2") == std::vector{lifted, none, lifted});
    CHECK(pixels("T0 P0~") == std::vector{none});
}

TEST_CASE("layers are paired as trying every pairing says") {
    for_all([](Random& random) {
        const Stack stack = random_stack(random, random.between(1, 6), random.between(1, 6), 4);
        INFO(to_text(stack));
        REQUIRE(layer_pixels(stack) == tried_out(stack));
    });
}

TEST_CASE("layer pictures show each stack's layer in its place") {
    const Block block = layered();
    const Pixels picture =
        read_pixels(draw({}, cloth_of(block), {.view = View::layers}, PictureFormat::png).value());
    const auto grids = layer_grids(block);
    REQUIRE(grids.size() == 3);
    for (std::size_t layer = 0; layer < 3; ++layer) {
        for (std::size_t row = 0; row < 2; ++row) {
            for (std::size_t column = 0; column < 3; ++column) {
                const auto of_stack = layer_pixels(block.stack(row, column));
                const LayerPixel pixel = layer < of_stack.size() ? of_stack[layer] : none;
                const Colour seen = picture.at(grids[layer].centre(row, column));
                CHECK((seen == Colour{0, 0, 0}) == (pixel == lifted));
                CHECK((seen == Colour{255, 255, 255}) == (pixel == over));
            }
        }
    }
}

TEST_CASE("the placeholders beside the web of the I-beam are no layer") {
    const Design design = sample_design("i-beam");
    const Evaluation cloth = evaluate(design).value();
    const Block& block = *cloth.block;
    CHECK(layer_count(block) == 10);  // three wefts in each flange, four in the web
    for (std::size_t row = 0; row < block.rows(); ++row) {
        for (std::size_t column = 0; column < block.columns(); ++column) {
            const bool web = column >= 8 && column < 12;
            const auto layers = layer_pixels(block.stack(row, column));
            for (std::size_t layer = 3; layer < 7; ++layer) CHECK((layers[layer] == none) == !web);
            for (const std::size_t layer : {0U, 1U, 2U, 7U, 8U, 9U}) CHECK(layers[layer] != none);
        }
    }
    const auto marks = marks_of(design, block, {.view = View::layers});
    CHECK(says(marks, "Layer 10 (bottom)"));
    CHECK(says(marks, "no such layer here"));
    CHECK(says(marks, "loose on purpose are left out"));
}

TEST_CASE("no layer of a cloth whose ends all interlace is all black") {
    const Evaluation cloth = evaluate(sample_design("tl013-corrected")).value();
    const Block& block = *cloth.block;
    std::vector<std::set<LayerPixel>> seen(layer_count(block));
    for (const Stack& stack : block.stacks()) {
        const auto layers = layer_pixels(stack);
        for (std::size_t k = 0; k < layers.size(); ++k) seen[k].insert(layers[k]);
    }
    REQUIRE(seen.size() == 6);
    for (const auto& pixels_seen : seen) CHECK((pixels_seen.contains(lifted) && pixels_seen.contains(over)));
}
