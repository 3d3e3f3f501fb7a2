// Slices written as text, and the design that they are.

#include <weave/design/evaluate.hpp>
#include <weave/io/slices_text.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

constexpr const char* plain =
    "# two ends of a plain weave\n"
    "P0 T0   # the end passes under the first pick\r\n"
    "T0 P0\n"
    "\n"
    "   \n"
    "T0 P0\n"
    "# a remark parts nothing\n"
    "P0 T0\n"
    "\n";

std::string text_of(const std::vector<Slice>& slices) {
    std::string text;
    for (const Slice& slice : slices) {
        for (const auto& position : slice.positions) text += to_text(position) + "\n";
        text += "\n";
    }
    return text;
}

}  // namespace

TEST_CASE("slices along the warp lie side by side as columns") {
    const std::vector<Slice> slices = read_slices(plain, System::weft).value();
    REQUIRE(slices.size() == 2);
    CHECK((slices[0].positions.size() == 2 && slices[1].positions.size() == 2 && slices[0].dots == System::weft));
    const Design design = design_of_slices(slices);
    CHECK(design.root == "slices-1-to-2");
    const Evaluation evaluation = evaluate(design).value();
    const Block& block = *evaluation.block;
    CHECK((block.rows() == 2 && block.columns() == 2 && block.picks() == 2 && block.ends() == 2));
    CHECK(to_text(block.stack(0, 0)) == "P0 T0");
    CHECK(to_text(block.stack(1, 0)) == "T0 P0");
    CHECK(to_text(block.stack(0, 1)) == "T0 P0");
    CHECK(to_text(block.stack(1, 1)) == "P0 T0");
    const CardImage card = block.card_image();
    CHECK((card.weft_over(0, 0) && !card.weft_over(0, 1) && !card.weft_over(1, 0) && card.weft_over(1, 1)));
}

TEST_CASE("slices along the weft lie one after the other as rows") {
    const Design design = design_of_slices(read_slices("T0 P0\nP0 T0\n\nP0 T0\nT0 P0", System::warp).value());
    const Evaluation evaluation = evaluate(design).value();
    CHECK((evaluation.block->rows() == 2 && evaluation.block->columns() == 2));
    CHECK(to_text(evaluation.block->stack(0, 0)) == "T0 P0");
    CHECK(to_text(evaluation.block->stack(1, 0)) == "P0 T0");
}

TEST_CASE("any block's slices, written and read, are the block again") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        for (const System dots : {System::weft, System::warp}) {
            std::vector<Slice> slices;
            for (std::size_t line = 0; line < (dots == System::weft ? block.columns() : block.rows()); ++line)
                slices.push_back((dots == System::weft ? warp_slice(block, line) : weft_slice(block, line)).value());
            const auto read = read_slices(text_of(slices), dots);
            REQUIRE(read);
            REQUIRE(*read == slices);
            const auto made = evaluate(design_of_slices(slices));
            REQUIRE(made);
            REQUIRE(made->block->card_image() == block.card_image());
        }
    });
}

TEST_CASE("what is no slice is refused with its line") {
    const auto refused = [](const char* text) {
        const auto read = read_slices(text, System::weft);
        REQUIRE_FALSE(read);
        return read.error().text();
    };
    CHECK_THAT(refused("P0 T0\n\nP0 T0\nT0 PP\n"), Catch::Contains("line 4"));
    CHECK_THAT(refused("# P0 T0\n\n \n"), Catch::Contains("holds no slice"));
    CHECK_THAT(refused(""), Catch::Contains("holds no slice"));
    std::string many;
    for (int k = 0; k < 2049; ++k) many += "P0 T0\n\n";
    CHECK_THAT(refused(many.c_str()), Catch::Contains("line 4097") && Catch::Contains("2048 slices"));
    many.resize(many.size() - 7);
    CHECK(check(design_of_slices(read_slices(many, System::weft).value())));
}
