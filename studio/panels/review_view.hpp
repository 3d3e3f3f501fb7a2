#pragma once

#include <QWidget>

#include <optional>
#include <studio/jobs/mill_values.hpp>

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTextBrowser;

namespace weave::studio {

class ApprovalFlow;

/// What became of a revision: its state as a way, why it was rejected, what it lacks, and what others decided
/// and said of it.
class ReviewView : public QWidget {
    Q_OBJECT
  public:
    explicit ReviewView(QWidget* parent = nullptr);

    /// The revisions of the design; the one that was shown is kept, unless `wanted` names another.
    void show_history(const wire::MillHistory& history, std::optional<std::int64_t> wanted = {});
    void show(const wire::MillReview& review);
    /// No design with revisions is meant.
    void clear();
    [[nodiscard]] std::optional<std::int64_t> number() const;
    /// The comment that was sent stands at the mill.
    void take_commented();

  Q_SIGNALS:
    void revision_wanted(std::optional<std::int64_t> number);
    void comment_wanted(std::int64_t number, const QString& text);

  private:
    void judge();

    QComboBox* m_revisions;
    ApprovalFlow* m_flow;
    QLabel *m_state, *m_empty;
    QTextBrowser* m_talk;
    QLineEdit* m_comment;
    QPushButton* m_send;
    QWidget* m_whole;
    wire::MillHistory m_history;
    std::optional<wire::MillReview> m_review;
    std::optional<std::int64_t> m_asked;
};

/// A time of the mill as the person's clock has it.
QString time_in_words(const std::string& utc);

}  // namespace weave::studio
