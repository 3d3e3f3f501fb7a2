#include <studio/commands/add_block.hpp>

#include <weave/design/merge.hpp>

#include <QCoreApplication>

#include <memory>
#include <utility>

namespace weave::studio {

EditStep add_block(const Design& design, const std::string& wish, NodeSource source, std::string& name) {
    name = free_name(design, wish);
    return {QCoreApplication::translate("commands", "Add %1").arg(QString::fromStdString(name)),
            {PutBlock{name, std::make_shared<const Node>(Node{std::move(source), {}})}}};
}

}  // namespace weave::studio
