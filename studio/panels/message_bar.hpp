#pragma once

#include <QFrame>

#include <cstdint>

class QAction;
class QLabel;
class QToolButton;

namespace weave::studio {

/// A line that says what happened, without a box that has to be answered. It stays until it is closed, or
/// what it says is over.
class MessageBar : public QFrame {
    Q_OBJECT
  public:
    enum class Kind : std::uint8_t { note, warning, error };

    explicit MessageBar(QWidget* parent = nullptr);

    /// `offer`: what can be done about it, as a button; once it is done, however, there is nothing left to say.
    void tell(Kind kind, const QString& words, QAction* offer = nullptr);
    void clear();
    [[nodiscard]] QString words() const;
    [[nodiscard]] Kind kind() const { return m_kind; }

  private:
    void show_offer(QAction* offer);

    Kind m_kind = Kind::note;
    QLabel *m_icon, *m_words;
    QToolButton *m_offer, *m_close;
};

}  // namespace weave::studio
