#pragma once

#include <weave/design/outline.hpp>

#include <QWidget>

#include <cstdint>
#include <optional>
#include <studio/commands/flip_crossing.hpp>
#include <studio/commands/flip_stroke.hpp>
#include <studio/document/document.hpp>
#include <studio/editors/block_pictures.hpp>
#include <studio/editors/grid_canvas.hpp>
#include <vector>

class QComboBox;
class QHBoxLayout;
class QSpinBox;

namespace weave::studio {

class CardRegion;
class FloatLegend;

/// The card of the block that is shown, crossing by crossing: a click flips, or tells which yarns stand in the way. It also shows the
/// block's layers, faces and floats, a square a stack.
class CardEditor : public QWidget {
    Q_OBJECT
  public:
    explicit CardEditor(QWidget* parent = nullptr);

    /// From now on of this document; it must outlive this, or be followed by another.
    void show_document(Document* document);
    [[nodiscard]] GridCanvas& canvas() { return *m_canvas; }
    void show_mode(CardMode mode, std::size_t layer = 0);

  Q_SIGNALS:
    /// A line for the window's status: what lies under the mouse, or why something cannot be.
    void told(const QString& words);
    /// The person asks for the slice along the pick (weft) or the end (warp) of this crossing.
    void slice_wanted(weave::System dots, const weave::CardPlace& place);

  private:
    void make_view_row(QHBoxLayout& row);
    void make_tool_row(QHBoxLayout& row);
    void show_block();
    void show_picture(CellPicture picture, CardMode mode);
    void follow_place();
    void list_modes();
    [[nodiscard]] GridLabels labels() const;
    [[nodiscard]] CardPlace place_of(const GridCell& cell) const;
    [[nodiscard]] GridCell cell_of(const CardPlace& place) const;
    void flip(const std::vector<GridCell>& cells);
    void explain(const std::vector<GridCell>& refused, const QString& why, std::size_t flipped);
    void tell_of(const std::optional<GridCell>& cell);
    void offer(const GridCell& cell, const QPoint& where);

    Document* m_document = nullptr;
    GridCanvas* m_canvas;
    CardRegion* m_region;
    FloatLegend* m_legend;
    QComboBox* m_modes;
    QSpinBox* m_times_rows;
    QSpinBox* m_times_columns;
    BlockPtr m_block;  ///< that the picture is of
    CardMode m_mode = CardMode::card;
    CardMode m_shown_mode = CardMode::card;  ///< of the picture, which may come later than it is asked for
    std::size_t m_layer = 0, m_layers = 0;
    std::uint64_t m_wanted = 0;  ///< pictures asked for so far: only the last counts
};

}  // namespace weave::studio
