#include <studio/panels/design_tree.hpp>

#include <QContextMenuEvent>
#include <QCoreApplication>
#include <QDropEvent>
#include <QHeaderView>
#include <QPixmap>
#include <QScopedValueRollback>
#include <QScrollBar>

#include <algorithm>
#include <set>
#include <studio/jobs/words.hpp>
#include <studio/panels/plain_tip.hpp>

namespace weave::studio {

namespace {

constexpr int name_role = Qt::UserRole;
constexpr int deepest_again = 12, most_items = 4000;  ///< up to there a block unfolds wherever it is used

/// The words of each kind of block.
struct MadeBy {
    Q_DECLARE_TR_FUNCTIONS(weave::studio::DesignTree)
  public:
    QString operator()(const StacksLeaf&) const { return tr("stacks"); }
    QString operator()(const CardLeaf&) const { return tr("card image"); }
    QString operator()(const PresetLeaf& leaf) const { return words(leaf.preset.family); }
    QString operator()(const SliceLeaf&) const { return tr("drawn slice"); }
    QString operator()(const TileOperation& tile) const { return tr("repeat %1 × %2 × %3").arg(tile.x).arg(tile.y).arg(tile.z); }
    QString operator()(const AttachOperation& attach) const {
        static const std::vector<QString> where{tr("after the last pick"), tr("before the first pick"), tr("after the last end"), tr("before the first end"), tr("on top"), tr("below")};
        return tr("attached %1").arg(where[static_cast<std::size_t>(attach.face)]);
    }
    QString operator()(const StencilOperation& stencil) const { return tr("stencil of %n block(s)", nullptr, static_cast<int>(stencil.of.size())); }
    QString operator()(const RenumberOperation&) const { return tr("renumbered"); }
};

std::string name_of(const QTreeWidgetItem* item) {
    return item == nullptr ? std::string() : item->data(0, name_role).toString().toStdString();
}

}  // namespace

QString made_by(const Node& node) {
    QString text = std::visit(MadeBy{}, node.source);
    if (!node.flips.empty()) text += DesignTree::tr(", %n flip(s)", nullptr, static_cast<int>(node.flips.size()));
    return text;
}

DesignTree::DesignTree(QWidget* parent) : QTreeWidget(parent) {
    setObjectName("design-tree");
    setAccessibleName(tr("Blocks of the design"));
    setColumnCount(1);
    setHeaderHidden(true);
    setIconSize({fontMetrics().height() * 5 / 2, fontMetrics().height() * 5 / 2});
    setDragDropMode(QAbstractItemView::DragDrop);
    setDefaultDropAction(Qt::LinkAction);
    setEditTriggers(QAbstractItemView::EditKeyPressed);
    setUniformRowHeights(false);
    connect(this, &QTreeWidget::currentItemChanged, this, [this](QTreeWidgetItem* now) {
        if (!m_is_building && m_document != nullptr && now != nullptr && !name_of(now).empty()) m_document->focus().show_block(name_of(now));
    });
    connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item) {
        if (m_is_building) return;
        const QString from = words(name_of(item)), to = item->text(0).section('\n', 0, 0).trimmed();
        if (!to.isEmpty() && to != from) Q_EMIT renamed(from, to);
        QMetaObject::invokeMethod(this, &DesignTree::rebuild, Qt::QueuedConnection);  // the item is still being edited
    });
}

void DesignTree::show_document(Document* document) {
    if (m_document != nullptr) {
        m_document->disconnect(this);
        m_document->focus().disconnect(this);
    }
    m_document = document;
    if (document != nullptr) {
        connect(document, &Document::edited, this, &DesignTree::follow_edit);
        connect(document, &Document::block_made, this, &DesignTree::refresh);
        connect(&document->focus(), &Focus::block_changed, this, [this] { choose(m_document->shown_block()); });
    }
    rebuild();
}

std::string DesignTree::chosen() const {
    return name_of(currentItem());
}

void DesignTree::choose(const std::string& block) {
    if (chosen() == block) return;
    const auto found = m_items.find(block);
    if (found == m_items.end()) return;
    const QScopedValueRollback quiet(m_is_building, true);
    setCurrentItem(found->second);
}

/// Most edits leave the tree as it is: then only the lines of the blocks that changed are written anew.
void DesignTree::follow_edit() {
    const Design& design = m_document->design();
    bool is_same = design.root == m_root && design.blocks.size() == m_nodes.size();
    std::vector<std::string> changed;
    for (auto block = design.blocks.begin(); is_same && block != design.blocks.end(); ++block) {
        const auto before = m_nodes.find(block->first);
        is_same = before != m_nodes.end();
        if (!is_same || before->second == block->second) continue;
        is_same = children_of(*before->second) == children_of(*block->second);
        changed.push_back(block->first);
    }
    if (!is_same) return rebuild();
    for (const std::string& block : changed) refresh(words(block));
    m_nodes = design.blocks;
}

void DesignTree::rebuild() {
    const QScopedValueRollback quiet(m_is_building, true);
    clear();
    m_items.clear();
    m_nodes.clear();
    m_depth = 0;
    if (m_document == nullptr) return;
    const Design& design = m_document->design();
    m_root = design.root;
    m_nodes = design.blocks;
    add(design.root, nullptr, 0);
    std::set<std::string> in_cloth;
    for (const auto& [name, item] : m_items) in_cloth.insert(name);
    for (const auto& [name, node] : design.blocks) {
        if (!in_cloth.contains(name) && !m_items.contains(name)) add(name, nullptr, 0);
    }
    header()->setMinimumSectionSize((m_depth + 1) * indentation() + room_for_name());
    expandToDepth(2);
    const auto shown = m_items.find(m_document->shown_block());
    if (shown != m_items.end()) setCurrentItem(shown->second);
}

/// However deep a block lies, so much of it can be seen.
int DesignTree::room_for_name() const {
    return iconSize().width() + 16 * fontMetrics().averageCharWidth();
}

/// Qt scrolls to where the column begins, which says nothing of a block that lies deep.
void DesignTree::scrollTo(const QModelIndex& index, ScrollHint hint) {
    QTreeWidget::scrollTo(index, hint);
    const int beyond = visualRect(index).left() + room_for_name() - viewport()->width();
    if (beyond > 0) horizontalScrollBar()->setValue(horizontalScrollBar()->value() + beyond);
}

/// A block that several are made from unfolds under each of them, unless that would be without end: then under the first alone.
void DesignTree::add(const std::string& block, QTreeWidgetItem* above, int depth) {
    const bool unfolds = !m_items.contains(block) || (depth <= deepest_again && static_cast<int>(m_items.size()) <= most_items);
    auto* item = above == nullptr ? new QTreeWidgetItem(this) : new QTreeWidgetItem(above);
    item->setData(0, name_role, words(block));
    m_items.emplace(block, item);
    dress(*item, block);
    m_depth = std::max(m_depth, depth);
    if (!unfolds) return;
    std::set<std::string> listed;
    for (const std::string& child : children_of(*m_document->design().blocks.at(block))) {
        if (listed.insert(child).second) add(child, item, depth + 1);
    }
}

void DesignTree::dress(QTreeWidgetItem& item, const std::string& block) {
    const Design& design = m_document->design();
    const bool is_cloth = block == design.root;
    item.setText(0, words(block) + "\n" + (is_cloth ? tr("the cloth · ") : QString()) + made_by(*design.blocks.at(block)));
    item.setFlags(Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsDragEnabled | Qt::ItemIsDropEnabled | Qt::ItemIsEditable);
    QFont font = item.font(0);
    font.setBold(is_cloth);
    item.setFont(0, font);
    const QImage image = m_document->thumbnail_of(block);
    if (!image.isNull()) item.setIcon(0, QIcon(QPixmap::fromImage(image.scaled(96, 96, Qt::KeepAspectRatio, Qt::FastTransformation))));
    item.setToolTip(0, plain_tip(tr("%1: %2. Click to show it, F2 to rename it, drag it onto another block to attach it there").arg(words(block), made_by(*design.blocks.at(block)))));
}

void DesignTree::refresh(const QString& block) {
    const QScopedValueRollback quiet(m_is_building, true);
    const auto [first, last] = m_items.equal_range(block.toStdString());
    for (auto item = first; item != last; ++item) dress(*item->second, item->first);
}

// ---- Drag, drop, menu ----

void DesignTree::dragMoveEvent(QDragMoveEvent* event) {
    const auto* onto = itemAt(event->position().toPoint());
    if (event->source() == this && onto != nullptr) {
        event->setDropAction(Qt::LinkAction);
        event->accept();
    } else {
        event->ignore();
    }
}

void DesignTree::dropEvent(QDropEvent* event) {
    const auto* onto = itemAt(event->position().toPoint());
    if (event->source() != this || onto == nullptr || chosen().empty()) return event->ignore();
    event->setDropAction(Qt::LinkAction);
    event->accept();
    Q_EMIT dropped(words(chosen()), words(name_of(onto)), mapToGlobal(event->position().toPoint()));
}

void DesignTree::contextMenuEvent(QContextMenuEvent* event) {
    const auto* item = event->reason() == QContextMenuEvent::Keyboard ? currentItem() : itemAt(event->pos());
    if (item != nullptr) Q_EMIT menu_wanted(words(name_of(item)), event->globalPos());
}

}  // namespace weave::studio
