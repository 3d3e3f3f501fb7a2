#pragma once

#include <weave/block/block_grid.hpp>
#include <weave/curve/cloth_curves.hpp>

#include <QGroupBox>

#include <cstddef>
#include <optional>

class QLabel;
class QRadioButton;
class QSpinBox;

namespace weave::studio {

/// Which part of the cloth is simulated.
class RegionGroup : public QGroupBox {
    Q_OBJECT
  public:
    explicit RegionGroup(QWidget* parent = nullptr);

    /// Rows and columns of stacks of the whole cloth, and the picks and ends that each of them has.
    void set_cloth(const BlockGrid& grid);
    /// Nothing: the whole.
    [[nodiscard]] std::optional<Region> region() const;
    [[nodiscard]] QRadioButton* whole() const { return m_whole; }
    [[nodiscard]] QRadioButton* part() const { return m_part; }
    [[nodiscard]] QSpinBox* first_row() const { return m_first_row; }
    [[nodiscard]] QSpinBox* last_row() const { return m_last_row; }
    [[nodiscard]] QSpinBox* first_column() const { return m_first_column; }
    [[nodiscard]] QSpinBox* last_column() const { return m_last_column; }

  Q_SIGNALS:
    void edited();

  private:
    void keep_in_order();
    void tell_yarns();

    BlockGrid m_grid;
    QLabel* m_yarns;  ///< the part in picks and ends
    QRadioButton *m_whole, *m_part;
    QSpinBox *m_first_row, *m_last_row, *m_first_column, *m_last_column;
};

}  // namespace weave::studio
