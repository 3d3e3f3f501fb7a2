#pragma once

#include <studio/editors/slice_canvas.hpp>
#include <studio/editors/slice_edits.hpp>

#include <QAction>
#include <QActionGroup>

#include <functional>
#include <vector>

namespace weave::studio {

/// What a press of the mouse does to a drawn slice.
enum class SliceTool { select, draw, add_path, add_dot };

/// The drawing of one slice, edited by mouse and keys. Every gesture is one edited slice; nothing is undone
/// here.
class SliceEditCanvas : public SliceCanvas {
    Q_OBJECT
  public:
    explicit SliceEditCanvas(QWidget* parent = nullptr);

    void show_slice(const Slice& slice);
    /// Colours, feeders, and whether the weft wraps round, as of the design that the slice belongs to.
    void set_design(const Design& design);
    [[nodiscard]] const Slice& slice() const { return m_slice; }
    [[nodiscard]] SliceTool tool() const { return m_tool; }
    void set_tool(SliceTool tool);
    /// Actions for buttons and menus, by their object names: tools `select`, `draw`, `add_path`, `add_dot`;
    /// `remove`, `duplicate`, `enable`, `insert`, `earlier`, `later`, `insert_position` … `fit`.
    [[nodiscard]] QAction* action(const QString& name) const { return findChild<QAction*>(name); }
    void choose(const ChosenYarns& yarns);

  Q_SIGNALS:
    void edited(const weave::Slice& slice, const QString& what);
    void tool_changed(weave::studio::SliceTool tool);

  protected:
    bool event(QEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void contextMenuEvent(QContextMenuEvent* event) override;
    void hover(QPointF place, std::optional<SliceYarnId> yarn) override;
    [[nodiscard]] QString empty_words() const override;

  private:
    /// A path in the making: by position, where the pointer led it.
    struct Gesture {
        std::optional<std::size_t> path;  ///< none: a new one
        QPointF begin, last;
        bool moved = false;
        std::vector<std::optional<PathStep>> steps;
        std::vector<double> levels;  ///< as they are to be drawn
    };
    void make_actions();
    QAction* make(const QString& name, const QString& text, const QKeySequence& keys,
                  const std::function<void()>& what);
    void make_tool(SliceTool tool, const QString& name, const QKeySequence& keys);
    void name_tools();
    void apply(Result<SliceEdit> edit, QPoint place);
    void apply_at_marks(Result<SliceEdit> edit) { apply(std::move(edit), place_of_marks()); }
    void begin_gesture(QPointF place, std::optional<std::size_t> path);
    void lead_gesture(QPointF place);
    void lead_to(std::size_t position, double level);
    void end_gesture(QPointF place);
    void press_to_draw(QPointF place);
    void select_at(QPointF place, bool more);
    void arrow_key(int up, int right);
    void step_yarn(int step);
    void tell_chosen();
    [[nodiscard]] std::size_t place_in_question() const;
    [[nodiscard]] std::size_t level_in_question() const;
    void edit_place(PositionEdit edit);
    [[nodiscard]] std::vector<SliceYarnId> all_yarns() const;

    Slice m_slice;
    Design m_design;
    SliceTool m_tool = SliceTool::select;
    QActionGroup m_tools;
    std::optional<Gesture> m_gesture;
    std::size_t m_last_position = 0;  ///< where the pointer was last, for edits of positions
};

}  // namespace weave::studio
