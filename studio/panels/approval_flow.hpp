#pragma once

#include <QWidget>

namespace weave::studio {

/// The way of a revision as stations side by side: saved, submitted, approved, released; where changes were
/// asked for, it ends there. Done stations have a tick, the one that is waited for a ring, so that colour
/// alone tells nothing.
class ApprovalFlow : public QWidget {
    Q_OBJECT
  public:
    explicit ApprovalFlow(QWidget* parent = nullptr);

    /// `state` as the mill writes it; empty: nothing is saved yet.
    void show_state(const QString& state);
    /// All of it in words, such as `saved, submitted; waits for approval`.
    [[nodiscard]] QString words() const;
    [[nodiscard]] QSize sizeHint() const override;
    [[nodiscard]] QSize minimumSizeHint() const override;

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    enum class Mark { done, waits, later, refused };
    struct Station {
        QString title;
        Mark mark = Mark::later;
    };
    [[nodiscard]] QList<Station> stations() const;
    void paint_disc(QPainter& painter, const QRectF& place, Mark mark) const;

    QString m_state;
};

/// A state as people write it.
QString state_in_words(const QString& state);

}  // namespace weave::studio
