#pragma once

#include <weave/core/json.hpp>

#include <QTableWidget>

namespace weave::studio {

/// The yarn types of a system as a table to edit: name, colour, radius, weight, stiffness. Its rows are the `yarns` of a document's plan.
class YarnTable : public QTableWidget {
    Q_OBJECT
  public:
    explicit YarnTable(QWidget* parent = nullptr);

    void show_yarns(const Json& yarns);
    /// As they stand, right or wrong.
    [[nodiscard]] Json yarns() const;
    void add_yarn();
    void remove_chosen();

  Q_SIGNALS:
    void edited();

  protected:
    void resizeEvent(QResizeEvent* event) override;

  private:
    void fit_names();
    void fill_row(int row, const Json& yarn);
    void show_colour(QTableWidgetItem& patch, const QString& colour);
    static Json number_in(const QTableWidgetItem& cell);
    void ask_colour(int row);

    bool m_is_filling = false;
};

}  // namespace weave::studio
