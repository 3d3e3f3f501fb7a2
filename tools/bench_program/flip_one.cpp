#include "flip_one.hpp"

#include <weave/block/flip.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>

#include <stdexcept>

namespace weave::bench {

namespace {

bool may_flip(const Block& cloth, std::size_t pick, std::size_t end) {
    const std::size_t row = cloth.row_of_pick(pick), column = cloth.column_of_end(end);
    return flip(cloth.stack(row, column), pick - cloth.first_pick(row), end - cloth.first_end(column)).valid;
}

}  // namespace

void flip_one(Design& design, std::size_t number) {
    const BlockPtr cloth = evaluate(design)->block;
    const std::size_t end = number * 101 % cloth->ends();
    std::size_t pick = number * 997 % cloth->picks();
    for (std::size_t tries = 0; !may_flip(*cloth, pick, end); ++tries) {
        if (tries == cloth->picks()) throw std::runtime_error("no crossing of this end may flip");
        pick = (pick + 1) % cloth->picks();
    }
    if (!apply_edit(design, PutFlip{design.root, {pick, end, !cloth->weft_over(pick, end)}}))
        throw std::runtime_error("a crossing that may flip was not flipped");
}

}  // namespace weave::bench
