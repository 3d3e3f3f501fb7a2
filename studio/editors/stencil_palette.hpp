#pragma once

#include <studio/editors/block_choice.hpp>

#include <QColor>
#include <QListWidget>
#include <QMenu>
#include <QToolButton>

#include <optional>

namespace weave::studio {

/// One block of a stencil's palette.
struct PaletteEntry {
    QString name;
    QPixmap thumbnail;
    QColor colour;
    QString reason;                     ///< why it does not fit; empty where it does
    std::optional<std::size_t> stacks;  ///< of the picture that it gives, where they were counted
};

/// The blocks that a stencil numbers: choose, add, remove and reorder them. Blocks that do not fit are grey,
/// with the reason beside them.
class StencilPalette : public QWidget {
    Q_OBJECT
  public:
    explicit StencilPalette(QWidget* parent = nullptr);
    void show_entries(const std::vector<PaletteEntry>& entries);
    /// What can be added: names, and why not where there is a reason.
    void show_choices(const std::vector<BlockChoice>& choices);
    void choose(int entry) { m_list->setCurrentRow(entry); }
    [[nodiscard]] int chosen() const { return m_list->currentRow(); }
    [[nodiscard]] QListWidget& list() { return *m_list; }
    /// Its entries can be triggered one by one.
    [[nodiscard]] QMenu& add_menu() { return *m_menu; }

    /// The colour of the n-th block of a palette: Okabe-Ito, then Tol's muted ones, then shades of both.
    static QColor colour_of(std::size_t entry);

  Q_SIGNALS:
    void chosen_changed(int entry);
    void add_wanted(const QString& name);
    void remove_wanted(int entry);
    void move_wanted(int entry, int step);

  private:
    QToolButton* button(const QString& name, const QString& text, const QString& tip);
    QListWidget* m_list;
    QMenu* m_menu;
    QToolButton *m_add, *m_remove, *m_up, *m_down;
};

}  // namespace weave::studio
