#pragma once

#include <QFrame>

class QLabel;
class QToolButton;

namespace weave::studio {

/// A line at the top of a window for what a person must not miss, but need not answer: why something failed, or what was recovered.
class MessageBar : public QFrame {
    Q_OBJECT
  public:
    enum class Weight { info, failure };
    explicit MessageBar(QWidget* parent = nullptr);

    /// Stays until it is closed, or something else is said.
    void say(const QString& words, Weight weight);
    [[nodiscard]] QString words() const;

  private:
    QLabel* m_words;
};

}  // namespace weave::studio
