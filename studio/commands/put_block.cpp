#include <studio/commands/put_block.hpp>

#include <weave/design/merge.hpp>

#include <QCoreApplication>

#include <memory>

namespace weave::studio {

EditStep change_block(const Design& design, const std::string& name, NodeSource source, const QString& text) {
    const Node& before = *design.blocks.at(name);
    return {text, {PutBlock{name, std::make_shared<const Node>(Node{std::move(source), before.flips})}}};
}

EditStep add_block(const Design& design, const std::string& wish, NodeSource source, std::string& name) {
    name = free_name(design, wish);
    return {QCoreApplication::translate("commands", "Add %1").arg(QString::fromStdString(name)),
            {PutBlock{name, std::make_shared<const Node>(Node{std::move(source), {}})}}};
}

EditStep duplicate_block(const Design& design, const std::string& block, std::string& name) {
    name = free_name(design, block);
    return {QCoreApplication::translate("commands", "Duplicate %1").arg(QString::fromStdString(block)),
            {PutBlock{name, design.blocks.at(block)}}};
}

}  // namespace weave::studio
