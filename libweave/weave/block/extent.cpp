#include <weave/block/extent.hpp>

namespace weave {

Extent extent_of(const Block& block) {
    Extent extent{
        block.rows(), block.columns(), block.picks(), block.ends(), block.height(), block.stacks().size(), 0};
    for (const Stack& stack : block.stacks()) extent.slots += stack.height();
    return extent;
}

}  // namespace weave
