#include <studio/commands/compose_blocks.hpp>

#include <weave/design/merge.hpp>
#include <weave/design/outline.hpp>

#include <QCoreApplication>

#include <memory>
#include <utility>

namespace weave::studio {

namespace {

/// What the library says of a design whose cloth is this block.
Status check_block(Design design, const std::string& name, const NodePtr& node) {
    design.blocks[name] = node;
    design.root = name;
    WEAVE_CHECK_OK(outline(design));
    return {};
}

}  // namespace

Result<EditStep> compose_blocks(const Design& design, const std::string& grows, const std::string& wish,
                                NodeSource operation, std::string& name) {
    name = free_name(design, wish);
    const NodePtr node = std::make_shared<const Node>(Node{std::move(operation), {}});
    for (const std::string& child : children_of(*node)) {
        if (!design.blocks.contains(child)) return invalid("'" + child + "' is not a block of this design");
    }
    WEAVE_CHECK_OK(check_block(design, name, node));
    EditStep step{QCoreApplication::translate("commands", "Make %1").arg(QString::fromStdString(name)),
                  {PutBlock{name, node}}};
    if (design.root == grows) step.edits.push_back(SetRoot{name});
    return step;
}

}  // namespace weave::studio
