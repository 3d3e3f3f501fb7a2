// The small texts that people type: stacks, slices, sequences, colours, views.
#include "support/must.hpp"

#include <weave/block/slice.hpp>
#include <weave/core/colour.hpp>
#include <weave/core/text.hpp>
#include <weave/design/yarns.hpp>
#include <weave/picture/picture.hpp>

using namespace weave;
using fuzz::must;

namespace {

void try_stack(std::string_view text) {
    for (const std::size_t first : {std::size_t{0}, std::size_t{7}}) {
        const auto stack = parse_stack(text, first, first);
        if (!stack) continue;
        const auto again = parse_stack(to_text(*stack, first, first), first, first);
        must(again && *again == *stack, "a stack reads as it was written");
        if (!stack->check()) continue;
        must(stack->positions(System::weft).size() == stack->wefts(), "every weft has its place");
        must(stack->positions(System::warp).size() == stack->warps(), "every warp has its place");
    }
}

/// Each line is one position of a slice.
void try_slice(std::string_view text, System dots) {
    Slice slice{dots, {}};
    for (std::size_t at = 0; at <= text.size();) {
        const std::string_view line = text.substr(at, text.find('\n', at) - at);
        at += line.size() + 1;
        auto position = parse_slice_position(line);
        if (!position) return;
        const auto again = parse_slice_position(to_text(*position));
        must(again && *again == *position, "a position reads as it was written");
        slice.positions.push_back(std::move(*position));
    }
    const auto block = to_block(slice);
    if (!block) return;
    const auto drawn = dots == System::weft ? warp_slice(*block, 0) : weft_slice(*block, 0);
    must(static_cast<bool>(drawn), "a block from a slice has this slice");
    const auto again = to_block(*drawn);
    must(again && *again == *block, "the slice of a block gives the block");
}

void try_sequence(std::string_view text) {
    constexpr std::uint32_t below = 64;
    const auto sequence = parse_sequence(text, below);
    if (!sequence) return;
    must(!sequence->once.empty() && sequence->once.size() <= longest_sequence, "a sequence keeps its bounds");
    const std::string written = to_text(*sequence);
    const auto again = parse_sequence(written, below);
    must(again && *again == *sequence, "a sequence reads as it was written");
    must(to_text(*again) == written, "a sequence is written in one way");
}

void try_view(std::string_view text) {
    static const Result<Block> block = make_preset({"twill", {}});
    const auto request = parse_view(text, *block);
    if (!request) return;
    if (request->view == View::weft_slice) must(request->line < block->rows(), "a weft slice cuts the cloth");
    if (request->view == View::warp_slice)
        must(request->line < block->columns(), "a warp slice cuts the cloth");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    try_stack(text);
    try_slice(text, System::weft);
    try_slice(text, System::warp);
    try_sequence(text);
    try_view(text);
    if (const auto colour = parse_colour(text)) {
        const auto again = parse_colour(to_text(*colour));
        must(again && *again == *colour, "a colour reads as it was written");
    }
    if (const auto number = parse_whole(text))
        must(parse_whole(std::to_string(*number)) == number, "a number reads as written");
    return 0;
}
