#pragma once

#include <weave/curve/cloth_curves.hpp>

#include <QGroupBox>

#include <cstddef>
#include <optional>

class QRadioButton;
class QSpinBox;

namespace weave::studio {

/// Which part of the cloth is simulated.
class RegionGroup : public QGroupBox {
    Q_OBJECT
  public:
    explicit RegionGroup(QWidget* parent = nullptr);

    /// The whole cloth has so many rows and columns of stacks.
    void set_cloth_size(std::size_t rows, std::size_t columns);
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

    QRadioButton *m_whole, *m_part;
    QSpinBox *m_first_row, *m_last_row, *m_first_column, *m_last_column;
};

}  // namespace weave::studio
