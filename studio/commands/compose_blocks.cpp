#include <studio/commands/compose_blocks.hpp>

#include <weave/design/merge.hpp>
#include <weave/design/outline.hpp>

#include <QCoreApplication>

#include <memory>
#include <optional>
#include <utility>

namespace weave::studio {

namespace {

double ends_per_column(const BlockGrid& grid) {
    return static_cast<double>(grid.ends()) / static_cast<double>(grid.columns());
}

/// Layers that come on top of one another bring their own ends: to the centimetre there are so many more, and the cloth stays as wide
/// as it was.
std::optional<WarpPlan> denser_warp(const Design& design, const BlockGrid& before, const BlockGrid& after) {
    const double times = ends_per_column(after) / ends_per_column(before);
    if (design.scene.dy_mm || times == 1) return {};
    WarpPlan warp = design.warp;
    warp.density_ends_per_cm *= times;
    return warp;
}

/// A block that is not made is no place that anybody could look for.
Error without_place(Error error, const std::string& block) {
    if (error.where.starts_with(block)) error.where.clear();
    return error;
}

}  // namespace

Result<EditStep> compose_blocks(const Design& design, const std::string& grows, const std::string& wish,
                                NodeSource operation, std::string& name) {
    name = free_name(design, wish);
    const NodePtr node = std::make_shared<const Node>(Node{std::move(operation), {}});
    for (const std::string& child : children_of(*node)) {
        if (!design.blocks.contains(child)) return invalid("'" + child + "' is not a block of this design");
    }
    Design made = design;
    made.blocks[name] = node;
    made.root = name;
    auto after = outline(made);
    if (!after) return without_place(std::move(after).error(), "blocks." + name);
    EditStep step{QCoreApplication::translate("commands", "Make %1").arg(QString::fromStdString(name)),
                  {PutBlock{name, node}}};
    if (design.root != grows) return step;
    step.edits.push_back(SetRoot{name});
    const auto before = outline(design);
    if (!before) return step;  // there was no cloth to be as wide as
    if (auto warp = denser_warp(design, before->grid, after->grid)) step.edits.push_back(SetWarp{std::move(*warp)});
    return step;
}

}  // namespace weave::studio
