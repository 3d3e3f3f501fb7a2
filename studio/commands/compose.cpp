#include <studio/commands/compose.hpp>

#include <weave/design/merge.hpp>
#include <weave/design/outline.hpp>

#include <QCoreApplication>

#include <memory>

namespace weave::studio {

namespace {

QString named(const std::string& name) {
    return QString::fromStdString(name);
}

/// What the library says of a design whose cloth is this block.
Status check_block(Design design, const std::string& name, const NodePtr& node) {
    design.blocks[name] = node;
    design.root = name;
    WEAVE_CHECK_OK(outline(design));
    return {};
}

}  // namespace

Result<EditStep> compose(const Design& design, const std::string& grows, const std::string& wish, NodeSource operation, std::string& name) {
    name = free_name(design, wish);
    const NodePtr node = std::make_shared<const Node>(Node{std::move(operation), {}});
    for (const std::string& child : children_of(*node)) {
        if (!design.blocks.contains(child)) return invalid("'" + child + "' is not a block of this design");
    }
    WEAVE_CHECK_OK(check_block(design, name, node));
    EditStep step{QCoreApplication::translate("commands", "Make %1").arg(named(name)), {PutBlock{name, node}}};
    if (design.root == grows) step.edits.push_back(SetRoot{name});
    return step;
}

Result<EditStep> attach_block(const Design& design, const std::string& block, const std::string& other, Face face, std::string& name) {
    WEAVE_TRY(EditStep step, compose(design, block, block + "-with-" + other, AttachOperation{block, other, face}, name));
    step.text = QCoreApplication::translate("commands", "Attach %1 to %2").arg(named(other), named(block));
    return step;
}

Result<EditStep> tile_block(const Design& design, const std::string& block, std::size_t x, std::size_t y, std::size_t z, std::string& name) {
    WEAVE_TRY(EditStep step, compose(design, block, block + "-repeated", TileOperation{block, x, y, z}, name));
    step.text = QCoreApplication::translate("commands", "Repeat %1").arg(named(block));
    return step;
}

}  // namespace weave::studio
