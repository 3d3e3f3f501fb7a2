#pragma once

#include <QTreeWidget>

#include <cstddef>
#include <studio/jobs/state_words.hpp>
#include <vector>

namespace weave::studio {

/// What a weaver wants to know of the cloth at rest, and what is modelled and why, as two lists that open and
/// close. Lines that speak of a place lead there.
class SimulationFindings : public QTreeWidget {
    Q_OBJECT
  public:
    explicit SimulationFindings(QWidget* parent = nullptr);

    /// `is_known` false: nothing rests yet.
    void set_inspection(const std::vector<StateLine>& lines, bool is_known);
    void set_plan(const std::vector<QString>& lines);
    [[nodiscard]] QTreeWidgetItem* inspection() const { return m_inspection; }
    [[nodiscard]] QTreeWidgetItem* plan() const { return m_plan; }

  Q_SIGNALS:
    /// Pick and end from 0.
    void place_wanted(std::size_t pick, std::size_t end);

  protected:
    void changeEvent(QEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

  private:
    void lead_to(const QTreeWidgetItem* item);
    void colour_links();

    QTreeWidgetItem *m_inspection, *m_plan;
};

}  // namespace weave::studio
