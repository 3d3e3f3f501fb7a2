// Rules about the design itself: its stacks, and the flips that are stored on it.

#include <weave/loom/check_detail.hpp>

namespace weave::check_detail {

namespace {

void check_stacks(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "block.constraints");
    const Block& block = subject.block;
    for (std::size_t row = 0; row < block.rows(); ++row) {
        for (std::size_t column = 0; column < block.columns(); ++column) {
            const Stack& stack = block.stack(row, column);
            if (stack.wefts() == block.t()[row] && stack.warps() == block.p()[column]) continue;
            rule.find({block.first_pick(row), block.first_end(column)},
                      "the stack in row " + person(row) + ", column " + person(column) + " holds " +
                          counted(stack.wefts(), "pick") + " and " + counted(stack.warps(), "end") +
                          " instead of " + std::to_string(block.t()[row]) + " and " +
                          std::to_string(block.p()[column]));
        }
    }
    for (const Stack& stack : block.stacks()) {
        if (const Status status = stack.check(); !status) rule.find({}, status.error().text());
    }
}

void check_flips(const Subject& subject, CheckReport& report) {
    RuleReport rule(report, subject.profile, "flips.apply");
    for (const LostFlip& lost : subject.cloth.lost_flips) {
        // Numbers of a flip count in its own block; only in the root are they those of the cloth.
        const bool in_cloth = lost.block == subject.design.root;
        rule.find(in_cloth ? Place{lost.flip.pick, lost.flip.end} : Place{},
                  "the flip of pick " + person(lost.flip.pick) + " and end " + person(lost.flip.end) +
                      " in block '" + lost.block + "' no longer applies: " + lost.reason);
    }
}

}  // namespace

void check_structure(const Subject& subject, CheckReport& report) {
    check_stacks(subject, report);
    check_flips(subject, report);
}

}  // namespace weave::check_detail
