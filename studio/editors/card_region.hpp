#pragma once

#include <weave/block/card_wish.hpp>

#include <QList>
#include <QObject>

#include <cstdint>
#include <deque>
#include <functional>
#include <studio/document/document.hpp>
#include <studio/editors/grid_canvas.hpp>
#include <vector>

class QAction;
class QMenu;

namespace weave::studio {

/// What can be done with a chosen region of the card: it is copied, given one side, mirrored, filled, or another part floats over it
/// until it is put down. What is asked for is done beside the window's thread, one after the other, each on what the one before
/// left.
class CardRegion : public QObject {
    Q_OBJECT
  public:
    /// No region with more crossings is copied or changed at once: a person would wait.
    static constexpr std::size_t most_crossings = 500000;

    CardRegion(GridCanvas& canvas, QObject* parent);

    void show_document(Document* document);
    /// The block whose card the canvas shows; null while it shows none.
    void show_block(BlockPtr block);
    /// To flip, and to choose.
    [[nodiscard]] const QList<QAction*>& tools() const { return m_tools; }
    void fill_menu(QMenu& menu) const;
    /// What is chosen, as a person reads it; empty where nothing is.
    [[nodiscard]] QString words() const;

  Q_SIGNALS:
    void told(const QString& words);
    /// Crossings that stay as they are while others changed, and why the first of them does.
    void refused(const std::vector<weave::studio::GridCell>& cells, const QString& why, std::size_t changed);

  private:
    /// How a region is to look, from how it looks now.
    using Wish = std::function<CardImage(const CardImage& now)>;
    struct Deed {
        std::uint64_t number;
        QString text;
        GridRegion region;
        Wish wish;
    };
    QAction* make(const QString& name, const QString& text, const QKeySequence& keys, std::function<void()> deed);
    QAction* make_tool(const QString& name, const QString& text, const QString& tip, const QKeySequence& keys, GridTool tool);
    void make_actions();
    void follow_canvas();
    [[nodiscard]] QString words_of(const GridRegion& region) const;
    [[nodiscard]] CardWish wish_at(const GridRegion& region, CardImage pixels) const;
    [[nodiscard]] std::vector<GridCell> cells_of(const std::vector<Flip>& crossings, const GridRegion& region) const;
    [[nodiscard]] bool is_small(const GridRegion& region);
    [[nodiscard]] CardImage chosen_part() const;
    void copy();
    void duplicate();
    void paste();
    void fill();
    void let_float(CardImage part, GridCell first);
    void judge_floating();
    void put_down(const GridRegion& region);
    void ask(const QString& text, const GridRegion& region, Wish wish);
    void go_on();
    void end(const Deed& deed, const GrantedWish& granted);
    void tell_error(const Error& error);

    GridCanvas& m_canvas;
    Document* m_document = nullptr;
    BlockPtr m_block;
    QList<QAction*> m_tools;
    QList<QAction*> m_copies, m_changes;  ///< what can be done with a region, the former with a floating part too
    QAction* m_paste = nullptr;
    QAction* m_fill = nullptr;
    QAction* m_choose_all = nullptr;
    CardImage m_floating;
    std::deque<Deed> m_waiting;
    std::uint64_t m_asked = 0;  ///< deeds so far
    bool m_is_busy = false, m_is_judging = false, m_has_moved = false;
};

}  // namespace weave::studio
