#pragma once

#include <studio/editors/slice_read_canvas.hpp>

#include <QComboBox>
#include <QLabel>
#include <QScrollBar>
#include <QSlider>
#include <QSpinBox>

namespace weave::studio {

/// Any block as slices, with a chooser for the row or column. A large block is read beside the window's
/// thread.
class SliceReader : public QWidget {
    Q_OBJECT
  public:
    explicit SliceReader(QWidget* parent = nullptr);
    /// The column `line` where the dots are wefts, or the row where they are warps.
    void show_block(const Design& design, BlockPtr block, System dots, std::size_t line);
    /// Brings this crossing to the middle as soon as the block that is shown next is there. From 0.
    void go_to(std::size_t pick, std::size_t end);
    [[nodiscard]] SliceReadCanvas& canvas() { return *m_canvas; }

  Q_SIGNALS:
    void flip_wanted(std::size_t pick, std::size_t end);
    void status(const QString& words);

  private:
    void take(std::shared_ptr<const BlockSlices> slices, std::size_t reading);
    void show_line();
    void set_direction(System dots);
    void set_line(int line);
    void name_line();
    void follow_canvas();

    SliceReadCanvas* m_canvas;
    QComboBox* m_direction;
    QLabel *m_kind, *m_count, *m_yarns;
    QSpinBox* m_number;
    QSlider* m_slider;
    QScrollBar* m_along;
    System m_dots = System::weft;
    std::size_t m_line = 0;
    std::optional<std::pair<std::size_t, std::size_t>> m_wanted;  ///< pick and end to go to
    std::size_t m_reading = 0;  ///< counts the blocks shown, so that one read too late is let go
};

}  // namespace weave::studio
