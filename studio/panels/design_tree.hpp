#pragma once

#include <weave/design/design.hpp>

#include <QTreeWidget>

#include <functional>
#include <map>
#include <studio/document/document.hpp>

namespace weave::studio {

/// The blocks of a design: the cloth with all that it is made from, and below it those that are in no cloth yet. A click shows a block in
/// the editors; one dragged onto another is attached to it.
class DesignTree : public QTreeWidget {
    Q_OBJECT
  public:
    explicit DesignTree(QWidget* parent = nullptr);

    void show_document(Document* document);
    /// The block that is chosen; empty where none is.
    [[nodiscard]] std::string chosen() const;
    void choose(const std::string& block);
    void scrollTo(const QModelIndex& index, ScrollHint hint = EnsureVisible) override;

  Q_SIGNALS:
    /// One block was dropped on another.
    void dropped(const QString& block, const QString& onto, const QPoint& where);
    void menu_wanted(const QString& block, const QPoint& where);
    void renamed(const QString& from, const QString& to);

  protected:
    void dropEvent(QDropEvent* event) override;
    void dragMoveEvent(QDragMoveEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;

  private:
    void follow_edit();
    void rebuild();
    void add(const std::string& block, QTreeWidgetItem* above, int depth);
    [[nodiscard]] int room_for_name() const;
    void dress(QTreeWidgetItem& item, const std::string& block);
    void refresh(const QString& block);

    Document* m_document = nullptr;
    std::multimap<std::string, QTreeWidgetItem*> m_items;
    std::string m_root;
    int m_depth = 0;  ///< of what is listed
    std::map<std::string, NodePtr> m_nodes;  ///< as they are shown
    bool m_is_building = false;
};

/// What a block is made by, in words: `twill`, `drawn`, `repeat of satin`.
QString made_by(const Node& node);

}  // namespace weave::studio
