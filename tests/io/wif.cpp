#include <weave/core/file.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/io/wif.hpp>

#include <support/random.hpp>

using namespace weave;
using weave::testing::for_all;
using weave::testing::property_cases;
using weave::testing::Random;

namespace {

const CardLeaf& leaf_of(const Design& design) {
    return std::get<CardLeaf>(design.blocks.at(design.root)->source);
}

std::string rows_of(const CardImage& card) {
    std::string text;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        if (pick > 0) text += '/';
        for (std::size_t end = 0; end < card.ends(); ++end) text += card.weft_over(pick, end) ? '-' : '#';
    }
    return text;
}

Colour random_colour(Random& random) {
    const auto part = [&] { return static_cast<std::uint8_t>(random.between(0, 255)); };
    return {part(), part(), part()};
}

YarnType random_yarn(Random& random) {
    static const char* const names[] = {"", "wool; 2/8", "  blanks  ", "Gr\xc3\xbcn \"quoted\"\n", "=[x]"};
    YarnType yarn;
    yarn.name = names[random.between(0, 4)];
    yarn.colour = random_colour(random);
    yarn.radius_mm = static_cast<double>(random.between(1, 3000)) / 997;
    yarn.linear_density_tex = static_cast<double>(random.between(1, 3000)) / 7;
    return yarn;
}

Design random_design(Random& random) {
    Design design;
    static const char* const texts[] = {"", "Toe; of a shoe", " [WIF]\r\nline 2 ", "\xc3\xa9\xe2\x82\xac",
                                        "a\tb\x01"};
    design.title = texts[random.between(0, 4)];
    design.notes = texts[random.between(0, 4)];
    design.root = "any.name";
    design.blocks[design.root] = std::make_shared<const Node>(
        Node{StacksLeaf{std::make_shared<const Block>(weave::testing::random_block(random))}, {}});
    const auto indices = [&](std::size_t below) {
        Sequence sequence{{}};
        for (std::size_t k = random.between(1, 5); k > 0; --k)
            sequence.once.push_back(static_cast<std::uint32_t>(random.between(0, below - 1)));
        return sequence;
    };
    WarpPlan& warp = design.warp;
    for (std::size_t k = random.between(0, 2); k > 0; --k) warp.yarns.push_back(random_yarn(random));
    for (std::size_t k = random.between(0, 2); k > 0; --k) warp.colours.push_back(random_colour(random));
    warp.beams.push_back({"upper"});
    warp.order = indices(warp.yarns.size());
    warp.beam_order = indices(2);
    warp.colour_order = indices(warp.colours.size() + 1);
    warp.density_ends_per_cm = static_cast<double>(random.between(1, 5000)) / 13;
    WeftPlan& weft = design.weft;
    weft.yarns = {random_yarn(random), random_yarn(random)};
    weft.feeders = {{"a", 0}, {"b", 1}, {"c", 1}};
    weft.feeder_order = {{0}, {2, 1}, {}, {static_cast<std::uint32_t>(random.between(0, 2))}};
    if (random.coin()) weft.directions = {Direction::right_to_left, Direction::left_to_right};
    if (random.coin()) weft.take_up = {true, false, true};
    weft.density_picks_per_cm = static_cast<double>(random.between(1, 5000)) / 17;
    return design;
}

std::string written(const Design& design) {
    const Result<Evaluation> cloth = evaluate(design);
    REQUIRE(cloth);
    const Result<std::string> text = write_wif(design, *cloth->block, cloth->block->card_image());
    REQUIRE(text);
    return *text;
}

/// The text without our section, as another program would hand it on.
std::string without_ours(std::string text) {
    text.resize(text.rfind("[PRIVATE WEAVE DESIGN]"));
    return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a design of ours comes back from WIF as it was") {
    for_all([](Random& random) {
        const Design design = random_design(random);
        const Block& block = *std::get<StacksLeaf>(design.blocks.at(design.root)->source).block;
        const Result<DesignFromWif> read = read_wif(written(design));
        REQUIRE(read);
        REQUIRE(read->warnings.empty());
        REQUIRE(*leaf_of(read->design).card == block.card_image());
        REQUIRE(read->design.title == design.title);
        REQUIRE(read->design.notes == design.notes);
        REQUIRE(read->design.warp == design.warp);
        REQUIRE(read->design.weft == design.weft);
        const Result<Evaluation> again = evaluate(read->design);
        REQUIRE(again);
        REQUIRE(again->block->t() == block.t());
        REQUIRE(again->block->p() == block.p());
    });
}

TEST_CASE("what every program can see of our WIF says the same as our own section") {
    for_all(
        [](Random& random) {
            Design design = random_design(random);
            const Block& block = *std::get<StacksLeaf>(design.blocks.at(design.root)->source).block;
            const Result<DesignFromWif> read = read_wif(without_ours(written(design)));
            REQUIRE(read);
            const WarpPlan &warp = read->design.warp, &told = design.warp;
            REQUIRE(*leaf_of(read->design).card == block.card_image());
            REQUIRE(warp.density_ends_per_cm == Approx(told.density_ends_per_cm));
            for (std::size_t end = 0; end < block.ends(); ++end) {
                const auto colour = [&](const WarpPlan& plan) {
                    const std::uint32_t k = plan.colour_order.at(end);
                    return k == 0 ? plan.yarns[plan.order.at(end)].colour : plan.colours[k - 1];
                };
                REQUIRE(colour(warp) == colour(told));
                REQUIRE(warp.yarns[warp.order.at(end)].radius_mm ==
                        Approx(told.yarns[told.order.at(end)].radius_mm));
            }
            for (std::size_t pick = 0; pick < block.picks(); ++pick) {
                const auto yarn = [&](const WeftPlan& plan) {
                    const FeederSet& set = plan.feeder_order[pick % plan.feeder_order.size()];
                    return plan.yarns[plan.feeders[set.empty() ? 0 : set[0]].yarn];
                };
                REQUIRE(yarn(read->design.weft).colour == yarn(design.weft).colour);
                REQUIRE(yarn(read->design.weft).radius_mm == Approx(yarn(design.weft).radius_mm));
            }
        },
        property_cases() / 5);
}

TEST_CASE("a WIF of ours holds what the standard demands") {
    CardImage card(2, 5);  // ends 1, 3, 5 lifted in pick 1, end 2 in pick 2, end 4 never
    for (const std::size_t end : {1, 3}) card.set(0, end, true);
    for (const std::size_t end : {0, 2, 3, 4}) card.set(1, end, true);
    Design design;
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(card);
    design.blocks["cloth"] = std::make_shared<const Node>(Node{leaf, {}});
    const std::string text = written(design);
    CHECK(
        text.find(
            "[WIF]\r\nVersion=1.1\r\nDate=April 20, 1997\r\nDevelopers=wif@mhsoft.com\r\nSource Program=") ==
        0);
    CHECK(text.find("Shafts=3\r\nTreadles=3\r\nRising Shed=true\r\n") != std::string::npos);
    CHECK(text.find("[THREADING]\r\n1=1\r\n2=2\r\n3=1\r\n4=3\r\n5=1\r\n") != std::string::npos);
    CHECK(text.find("[LIFTPLAN]\r\n1=1\r\n2=2\r\n") != std::string::npos);
    CHECK(text.find("LIFTPLAN=true\r\nPRIVATE WEAVE DESIGN=true\r\n") != std::string::npos);
    CHECK(text.find("TIEUP") == std::string::npos);
    CHECK(text.find("[COLOR PALETTE]\r\nEntries=2\r\nForm=RGB\r\nRange=0,255\r\n") != std::string::npos);
    CHECK(text.find("Units=centimeters\r\nSpacing=0.05\r\nThickness=0.03\r\n") != std::string::npos);
}

TEST_CASE("line ends may change on the way without harm to our own section") {
    Random random(7);
    const Design design = random_design(random);
    std::string text = written(design);
    std::erase(text, '\r');
    const Result<DesignFromWif> read = read_wif(text);
    REQUIRE(read);
    CHECK(read->warnings.empty());
    CHECK(read->design.weft == design.weft);
}

TEST_CASE("what another program changed wins over our own section, with a warning") {
    Design design;
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(4, 4);
    leaf.t = {2};
    design.blocks["cloth"] = std::make_shared<const Node>(Node{leaf, {}});
    design.weft.feeders[0].name = "cone";
    const std::string text = written(design);

    const Result<DesignFromWif> recoloured = read_wif(replaced(text, "1=217,138,43", "1=1,2,3"));
    REQUIRE(recoloured);
    REQUIRE(recoloured->warnings.size() == 1);
    CHECK(recoloured->warnings[0].find("was changed since") != std::string::npos);
    CHECK(recoloured->design.warp.yarns[0].colour == Colour{1, 2, 3});
    CHECK(leaf_of(recoloured->design).t == std::vector<std::uint32_t>{2});

    const Result<DesignFromWif> rewoven =
        read_wif(replaced(text, "[LIFTPLAN]\r\n1=1\r\n", "[LIFTPLAN]\r\n1=0\r\n"));
    REQUIRE(rewoven);
    CHECK(rewoven->warnings.size() == 1);
    CHECK(rows_of(*leaf_of(rewoven->design).card) == "----/####/####/####");
    CHECK(leaf_of(rewoven->design).t == std::vector<std::uint32_t>{1});
}

TEST_CASE("a broken section of ours is refused with its line") {
    Design design;
    design.root = "cloth";
    CardLeaf leaf;
    leaf.card = std::make_shared<const CardImage>(3, 4);
    design.blocks["cloth"] = std::make_shared<const Node>(Node{leaf, {}});
    const std::string text = written(design);
    for (const auto& [from, to] : {std::pair{"rows=1\r", "rows=2\r"}, std::pair{"rows=1\r", "rows=x\r"},
                                   std::pair{"columns=1\r", "columns=0\r"}, std::pair{"1=\"{", "1={"},
                                   std::pair{"\"notes\":\"\"", "\"notes\":7"}, std::pair{"\"{\"title", "\"{\"other"}}) {
        REQUIRE(text.find(from) != std::string::npos);
        const Result<DesignFromWif> read = read_wif(replaced(text, from, to));
        REQUIRE_FALSE(read);
        CHECK(read.error().where.find("line ") == 0);
    }
}

TEST_CASE("the writer refuses a card that is not the block's") {
    Random random(1);
    const Design design = random_design(random);
    const Block& block = *std::get<StacksLeaf>(design.blocks.at(design.root)->source).block;
    CHECK_FALSE(write_wif(design, block, CardImage(block.picks() + 1, block.ends())));
}

TEST_CASE("no damage to a WIF file brings the reader down") {
    const std::string folder = WEAVE_SOURCE_DIR "/tests/fixtures/wif/";
    std::vector<std::string> files;
    for (const char* name : {"treadled_twill.wif", "dobby_falling.wif", "from_zero.wif"}) {
        const Result<std::string> text = read_file(folder + name);
        REQUIRE(text);
        files.push_back(*text);
    }
    Random first(3);
    files.push_back(written(random_design(first)));
    std::size_t read_well = 0, refused = 0;
    for_all([&](Random& random) {
        std::string text = files[random.between(0, files.size() - 1)];
        for (std::size_t k = random.between(1, 4); k > 0 && !text.empty(); --k) {
            const std::size_t at = random.between(0, text.size() - 1);
            switch (random.between(0, 4)) {
                case 0:
                    text.resize(at);
                    break;
                case 1:
                    text[at] = static_cast<char>(random.between(0, 255));
                    break;
                case 2:
                    text.erase(at, random.between(1, 30));
                    break;
                case 3:
                    text.insert(at, text.substr(random.between(0, text.size() - 1), random.between(1, 60)));
                    break;
                default:
                    text.insert(at, random.coin() ? "99999999999" : "0");
                    break;
            }
        }
        const Result<DesignFromWif> read = read_wif(text);
        if (read) {
            REQUIRE(check(read->design));
            ++read_well;
        } else {
            INFO(read.error().text());
            REQUIRE(read.error().where.find("line ") == 0);
            REQUIRE_FALSE(read.error().message.empty());
            ++refused;
        }
    });
    CHECK(read_well > 0);
    CHECK(refused > 0);
}
