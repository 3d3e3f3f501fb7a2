#pragma once

#include <weave/block/stencil_edit.hpp>
#include <weave/io/stencil_picture.hpp>
#include <studio/editors/block_choice.hpp>

#include <QButtonGroup>
#include <QComboBox>
#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QSpinBox>

#include <functional>

namespace weave::studio {

/// Asks for a new size of a stencil, in stacks, and for the part that stays where it is.
class StencilSizeDialog : public QDialog {
    Q_OBJECT
  public:
    StencilSizeDialog(std::size_t rows, std::size_t columns, QWidget* parent);
    [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(m_rows->value()); }
    [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(m_columns->value()); }
    [[nodiscard]] Keep rows_kept() const { return static_cast<Keep>(2 - m_anchor->checkedId() / 3); }
    [[nodiscard]] Keep columns_kept() const { return static_cast<Keep>(m_anchor->checkedId() % 3); }

  private:
    QSpinBox *m_columns, *m_rows;  // the first to be filled in first
    QButtonGroup* m_anchor;  ///< nine buttons, row by row from the top
};

/// Lists the colours of a picture, and asks for the block that each one stands for. What fits is asked again
/// with every choice, since blocks have to agree with one another.
class PictureMapDialog : public QDialog {
    Q_OBJECT
  public:
    /// Why these blocks (by their places in the list of choices) cannot be in one stencil; empty where they
    /// can.
    using Obstacle = std::function<QString(const std::vector<std::size_t>&)>;
    PictureMapDialog(const std::vector<CountedColour>& colours, const std::vector<BlockChoice>& choices,
                     Obstacle obstacle, QWidget* parent);
    /// The block of each colour.
    [[nodiscard]] std::vector<std::string> blocks() const;

  private:
    void check();
    Obstacle m_obstacle;
    std::vector<QComboBox*> m_boxes;
    std::vector<std::string> m_names;  ///< of the choices
    QLabel* m_trouble;
    QPushButton* m_accept;
};

}  // namespace weave::studio
