#pragma once

#include <QLabel>

namespace weave::studio {

/// Words about what went wrong, in place, never in the way: gone while there are none.
class TroubleLabel : public QLabel {
  public:
    explicit TroubleLabel(QWidget* parent = nullptr);
    void setText(const QString& words);
    /// What was copied from one, without the places at which fingerprints may go on in the next line.
    [[nodiscard]] static QString as_typed(QString words);
};

}  // namespace weave::studio
