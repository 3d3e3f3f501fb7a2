#pragma once

#include <weave/block/from_card.hpp>

#include <QDialog>

#include <vector>

class QListWidget;

namespace weave::studio {

/// A grouping in weavers' words, such as `2 picks a row, 2 ends a column`.
QString grouping_words(const Grouping& grouping);

/// Which of several ways to read a bare card is meant: how many picks and ends lie on top of one another.
class GroupingDialog : public QDialog {
    Q_OBJECT
  public:
    /// `groupings`, of which there is one at least, best first.
    explicit GroupingDialog(const std::vector<Grouping>& groupings, QWidget* parent = nullptr);

    [[nodiscard]] std::size_t chosen() const;

  private:
    QListWidget* m_list;
};

}  // namespace weave::studio
