#include <weave/block/preset.hpp>

#include <block/brute.hpp>
#include <numeric>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::string card_of(const Preset& preset) {
    const CardImage card = make_preset(preset).value().card_image();
    std::string text;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        if (pick > 0) text += '/';
        for (std::size_t end = 0; end < card.ends(); ++end) text += card.weft_over(pick, end) ? '.' : '#';
    }
    return text;
}

std::string refusal(const Preset& preset) {
    return make_preset(preset).error().message;
}

bool all_bind(const CardImage& card) {
    const auto varies = [](const CardImage& lines) {
        for (std::size_t line = 0; line < lines.picks(); ++line) {
            std::size_t over = 0;
            for (std::size_t k = 0; k < lines.ends(); ++k) over += lines.weft_over(line, k) ? 1 : 0;
            if (over == 0 || over == lines.ends()) return false;
        }
        return true;
    };
    return varies(card) && varies(card.transposed());
}

}  // namespace

TEST_CASE(
    "any preset of any size is a block in which every pick and every end binds, or a refusal that says why") {
    std::vector<std::size_t> made(preset_families().size());
    for_all(
        [&](Random& random) {
            const std::size_t which = random.between(0, made.size() - 1);
            Preset preset{preset_families()[which].name, {}};
            for (const PresetOption& option : preset_families()[which].options) {
                const std::int64_t low = std::max<std::int64_t>(option.low, -12),
                                   high = std::min<std::int64_t>(option.high, 12);
                const auto spread = static_cast<std::size_t>(high - low);
                preset.options[option.name] = low + static_cast<std::int64_t>(random.between(0, spread));
            }
            if (preset.options.contains("stitch")) preset.options["stitch"] %= 4;
            if (preset.options.contains("stuffers")) preset.options["stuffers"] %= 3;
            const auto block = make_preset(preset);
            if (!block) {
                REQUIRE(block.error().code == ErrorCode::invalid);
                REQUIRE(block.error().message.size() > 20);
                return;
            }
            ++made[which];
            REQUIRE(all_bind(block->card_image()));
            if (block->rows() * block->columns() < 400) REQUIRE(obeys(plain(*block)));
        },
        property_cases());
    for (const std::size_t count : made) REQUIRE(count > 0);
}

TEST_CASE("the classic weaves look as weaving books draw them, first pick first") {
    REQUIRE(card_of({"plain", {}}) == "#./.#");
    REQUIRE(card_of({"twill", {{"up", 2}, {"down", 1}}}) == "##./.##/#.#");
    REQUIRE(card_of({"twill", {{"up", 1}, {"down", 3}, {"step", -1}}}) == "#.../...#/..#./.#..");
    REQUIRE(card_of({"sateen", {{"size", 5}, {"move", 2}}}) == "#..../..#../....#/.#.../...#.");
    REQUIRE(card_of({"satin", {{"size", 5}, {"move", 3}}}) == ".####/###.#/#.###/####./##.##");
    REQUIRE(card_of({"satin", {{"move", 3}, {"weft-faced", 1}}}) == card_of({"sateen", {{"move", 3}}}));
    REQUIRE(card_of({"rib", {{"second", 1}}}) == "#./#./.#");
    REQUIRE(card_of({"rib", {{"weft-rib", 1}}}) == "##../..##");
    REQUIRE(card_of({"basket", {{"picks", 1}}}) == "##../..##");
    REQUIRE(card_of({"pointed-twill", {}}) == "##...#/.##.##/..###./#..#..");
    REQUIRE(card_of({"herringbone", {}}) == "##..##../.##.#..#/..##..##/#..#.##.");
    REQUIRE(card_of({"multi-layer", {}}) == "##.#/.#../.###/...#");
}

TEST_CASE("single-layer families have one pick and one end a stack, layered ones real stacks") {
    for (const PresetFamily& family : preset_families()) {
        INFO(family.name);
        const Block block = make_preset({family.name, {}}).value();
        const bool layered = std::any_of(family.options.begin(), family.options.end(),
                                         [](const PresetOption& option) { return option.name == "layers"; });
        REQUIRE((block.t()[0] > 1) == layered);
        REQUIRE(all_bind(block.card_image()));
        REQUIRE_FALSE(family.help.empty());
        for (const PresetOption& option : family.options) {
            REQUIRE(option.low <= option.fallback);
            REQUIRE(option.fallback <= option.high);
            REQUIRE_FALSE(option.help.empty());
        }
    }
    const Block interlock = make_preset({"angle-interlock", {{"layers", 4}, {"step", 2}}}).value();
    REQUIRE(interlock.t() == std::vector<std::uint32_t>(4, 4));
    std::vector<std::string> climb;
    for (std::size_t row = 0; row < 4; ++row) climb.push_back(to_text(interlock.stack(row, 0)));
    REQUIRE(climb ==
            std::vector<std::string>{"P0 T0 - T1 - T2 - T3", "- T0 - T1 P0 T2 - T3", "- T0 - T1 - T2 - T3 P0",
                                     "- T0 - T1 P0 T2 - T3"});
    const Block orthogonal = make_preset({"orthogonal", {}}).value();
    REQUIRE(orthogonal.p() == std::vector<std::uint32_t>{1, 2, 1, 2});
    const Block bound = make_preset({"layer-to-layer", {}}).value();
    REQUIRE(bound.p() == std::vector<std::uint32_t>{3, 3});
    REQUIRE(to_text(bound.stack(0, 0)) == "P0 T0 P1 T1 P2 T2 - T3");
    for (const char* family : {"orthogonal", "layer-to-layer", "angle-interlock"}) {
        INFO(family);
        const Block level = make_preset({family, {{"stuffers", 1}}}).value();
        for (const Stack& stack : level.stacks())
            REQUIRE(stack.positions(System::weft) == level.stack(0, 0).positions(System::weft));
    }
}

TEST_CASE("a stitch ties each cloth to the next with one pixel and no more") {
    for (std::int64_t weave = 0; weave <= 2; ++weave) {
        for (std::int64_t stitch = 1; stitch <= 4; ++stitch) {
            const Block tied =
                make_preset({"multi-layer", {{"layers", 4}, {"weave", weave}, {"stitch", stitch}}}).value();
            std::size_t ties = 0;
            const Plain block = plain(tied);
            const auto card = pixels(block);
            for (std::size_t pick = 0; pick < card.size(); ++pick) {
                for (std::size_t end = 0; end < card[pick].size(); ++end) {
                    const std::size_t pick_layer = pick % 4, end_layer = end % 4;
                    if (pick_layer < end_layer) REQUIRE_FALSE(card[pick][end]);
                    if (pick_layer <= end_layer || card[pick][end]) continue;
                    REQUIRE(pick_layer == end_layer + 1);
                    ++ties;
                }
            }
            REQUIRE(ties == 3 * static_cast<std::size_t>(stitch));
        }
    }
}

TEST_CASE("impossible presets are refused with what would be possible") {
    REQUIRE(refusal({"satin", {{"size", 8}, {"move", 4}}}) ==
            "a satin on 8 ends cannot have move 4: some ends would not bind; possible moves are 3 and 5");
    REQUIRE_THAT(refusal({"sateen", {{"size", 6}}}), Catch::Contains("no regular satin on 6 ends"));
    REQUIRE_THAT(refusal({"satin", {{"size", 5}, {"move", 7}}}), Catch::Contains("2 and 3"));
    REQUIRE_THAT(refusal({"twill", {{"up", 1}, {"down", 3}, {"step", 2}}}),
                 Catch::Contains("possible steps are 1 and 3"));
    REQUIRE_THAT(refusal({"twill", {{"step", 0}}}), Catch::Contains("never bind"));
    REQUIRE_THAT(refusal({"herringbone", {{"width", 3}}}), Catch::Contains("at least 4"));
    REQUIRE_THAT(refusal({"layer-to-layer", {{"layers", 3}, {"depth", 4}}}), Catch::Contains("at most 3"));
    REQUIRE_THAT(refusal({"angle-interlock", {{"layers", 3}, {"step", 4}}}), Catch::Contains("climb 4"));
    REQUIRE_THAT(refusal({"multi-layer", {{"size", 3}}}), Catch::Contains("plain weave has size 2"));
    REQUIRE_THAT(refusal({"multi-layer", {{"weave", 2}, {"size", 6}}}), Catch::Contains("no regular satin"));
    REQUIRE_THAT(refusal({"tweed", {}}), Catch::Contains("'tweed'") && Catch::Contains("herringbone"));
    REQUIRE_THAT(refusal({"plain", {{"up", 1}}}), Catch::Contains("no options"));
    REQUIRE(refusal({"twill", {{"up", 0}}}) == "'twill' takes up from 1 to 200, not 0");
    REQUIRE_THAT(refusal({"twill", {{"upp", 1}}}), Catch::Contains("only up, down, step"));
    REQUIRE_THAT(refusal({"multi-layer", {{"layers", 64}, {"weave", 1}, {"size", 32}, {"stitch", 32}}}),
                 Catch::Contains("65536 picks and 65536 ends is larger than the limit"));
}
