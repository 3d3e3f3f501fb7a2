#include <weave/design/document.hpp>
#include <weave/design/plan_json.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::string error_of(std::string_view text, std::uint32_t below = 10) {
    const Result<Sequence> sequence = parse_sequence(text, below);
    REQUIRE_FALSE(sequence);
    CHECK(sequence.error().code == ErrorCode::bad_input);
    return sequence.error().message;
}

/// A weft of eight feeders with this order, as a document says it.
Result<WeftPlan> weft_of(const std::string& order) {
    Json json = to_json(default_weft());
    for (int k = 1; k < 8; ++k) json["feeders"].push_back({{"name", "more"}});
    json["feeder_order"] = order;
    JsonReader reader(json, "weft");
    const WeftPlan weft = weft_from_json(reader);
    WEAVE_CHECK_OK(reader.status());
    return weft;
}

std::string weft_error(const std::string& order) {
    const Result<WeftPlan> weft = weft_of(order);
    REQUIRE_FALSE(weft);
    return weft.error().text();
}

}  // namespace

TEST_CASE("sequences are numbers with runs, and repeat for ever") {
    const Sequence sequence = parse_sequence(" 0*3 1  0*2 9 ", 10).value();
    CHECK(sequence.once == std::vector<std::uint32_t>{0, 0, 0, 1, 0, 0, 9});
    CHECK(to_text(sequence) == "0*3 1 0*2 9");
    CHECK(sequence.at(3) == 1);
    CHECK(sequence.at(7 * 1000 + 6) == 9);
    CHECK(to_text(parse_sequence("1*2 1 1*1", 2).value()) == "1*4");
    CHECK(parse_sequence("0*4194304", 1).value().once.size() == longest_sequence);
}

TEST_CASE("text that is no sequence is refused with the word at fault") {
    for (const char* word : {"x", "0*", "*3", "0*0", "0*-1", "-1", "+1", "1.5", "0**2", "0*2*2", "0*2x",
                             "0x1", "0,1", "99999999999", "0*99999999999", "0\t1", "0\n"}) {
        INFO(word);
        CHECK(error_of("1 " + std::string(word)) ==
              "'" + std::string(word) + "' is neither a number nor a run such as 0*12");
    }
    CHECK(error_of("") == "is empty, but needs at least one number");
    CHECK(error_of("   ") == "is empty, but needs at least one number");
    CHECK(error_of("0 3*7", 3) == "names number 3, but there are only 3, counted from 0");
    CHECK(error_of("0*4294967295") == "is longer than 4194304 elements");
    CHECK(error_of("0*4194304 0") == "is longer than 4194304 elements");
    CHECK(error_of(std::string(100000, '7') + "x").size() < 120);
}

TEST_CASE("a sequence reads back as it was, and its text is as short as runs make it") {
    for_all([](Random& random) {
        const std::size_t below = random.between(1, 5);
        const Sequence sequence = random_sequence(random, below);
        const std::string text = to_text(sequence);
        REQUIRE(parse_sequence(text, static_cast<std::uint32_t>(below)).value() == sequence);
        std::size_t runs = 1;
        for (std::size_t k = 1; k < sequence.once.size(); ++k)
            runs += sequence.once[k] != sequence.once[k - 1] ? 1 : 0;
        REQUIRE(static_cast<std::size_t>(std::count(text.begin(), text.end(), ' ')) == runs - 1);
    });
}

TEST_CASE("a feeder order gives each pick no feeder, one, or two") {
    CHECK(weft_of("0*2 0+1*3 - 7+2 -*2").value().feeder_order ==
          std::vector<FeederSet>{{0}, {0}, {0, 1}, {0, 1}, {0, 1}, {}, {7, 2}, {}, {}});
    CHECK(to_json(weft_of(" 0 0  0+1 0+1 1+0 - -").value())["feeder_order"] == "0*2 0+1*2 1+0 -*2");
    for_all(
        [](Random& random) {
            WeftPlan weft = default_weft();
            weft.feeders.resize(8, weft.feeders[0]);
            weft.feeder_order.clear();
            for (std::size_t k = random.between(1, 8); k > 0; --k) {
                FeederSet set;
                const std::size_t first = random.between(0, 7), kind = random.between(0, 2);
                if (kind > 0) set.push_back(static_cast<std::uint32_t>(first));
                if (kind > 1) set.push_back(static_cast<std::uint32_t>((first + random.between(1, 7)) % 8));
                weft.feeder_order.insert(weft.feeder_order.end(), random.between(1, 3), set);
            }
            REQUIRE(weft_of(to_json(weft)["feeder_order"]).value().feeder_order == weft.feeder_order);
        },
        property_cases());
}

TEST_CASE("text that is no feeder order is refused with the word at fault") {
    for (const char* word : {"x", "--", "-+1", "0+", "+0", "0+1+2", "0+-", "0*", "0*0", "*2", "0*2*2", "0*-1",
                             "0+1*x", "-0", "0;1", "99999999999"}) {
        INFO(word);
        CHECK(weft_error("1 " + std::string(word)) ==
              "weft.feeder_order: '" + std::string(word) +
                  "' is not a pick's feeders such as 0, 0+1, - or 0*12");
    }
    CHECK(weft_error("0*4194305") == "weft.feeder_order: is longer than 4194304 picks");
    CHECK(weft_error("-*4194304 0") == "weft.feeder_order: is longer than 4194304 picks");
    CHECK(weft_error(std::string(100000, '7')).size() < 150);
}

TEST_CASE("the yarns of a design that says nothing are sound") {
    const Design design = design_of({{"toe", plain()}}, "toe");
    CHECK(check(design));
    CHECK(design.warp.yarns.size() == 1);
    CHECK(design.weft.feeders.size() == 1);
}
