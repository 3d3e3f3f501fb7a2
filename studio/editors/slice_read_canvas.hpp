#pragma once

#include <studio/editors/slice_canvas.hpp>

#include <memory>

namespace weave::studio {

/// A row or column of any block as a slice, to read. Only the part that is seen is laid out. A click on a
/// crossing asks for the flip of its pixel.
class SliceReadCanvas : public SliceCanvas {
    Q_OBJECT
  public:
    explicit SliceReadCanvas(QWidget* parent = nullptr);
    /// Null while the block is read.
    void show_slices(std::shared_ptr<const BlockSlices> slices, System dots, std::size_t line);
    void set_line(System dots, std::size_t line);
    /// Brings a crossing of the line to the middle, and marks it.
    void show_crossing(std::size_t pick, std::size_t end);
    [[nodiscard]] System dots() const { return m_dots; }
    [[nodiscard]] std::size_t line() const { return m_line; }
    [[nodiscard]] const BlockSlices* slices() const { return m_slices.get(); }

  Q_SIGNALS:
    /// Pick and end from 0; the flip can be made.
    void flip_wanted(std::size_t pick, std::size_t end);

  protected:
    bool event(QEvent* event) override;
    void lay_out() override;
    void hover(QPointF place, std::optional<SliceYarnId> yarn) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    [[nodiscard]] QString empty_words() const override;

  private:
    /// A dot, and the path that is nearest to it on the pointer's side.
    struct Crossing {
        const SceneDot* dot = nullptr;
        const ScenePath* path = nullptr;
        std::size_t pick = 0, end = 0;
    };
    [[nodiscard]] std::optional<Crossing> crossing_of(const SceneDot& dot, const ScenePath& path) const;
    [[nodiscard]] std::optional<Crossing> crossing_at(QPointF place) const;
    [[nodiscard]] QString words_of(const Crossing& crossing) const;
    void ask_flip(const Crossing& crossing, QPoint place);
    void step(int along, int up);

    std::shared_ptr<const BlockSlices> m_slices;
    System m_dots = System::weft;
    std::size_t m_line = 0;
    std::optional<QPointF> m_pressed;
};

}  // namespace weave::studio
