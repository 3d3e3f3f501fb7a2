#pragma once

#include <QWidget>

#include <optional>
#include <studio/jobs/mill_values.hpp>

class QComboBox;
class QLabel;
class QPlainTextEdit;
class QToolButton;

namespace weave::studio {

class ScaledPicture;

/// In what the open design differs from a revision: in words, and as a picture of both cards laid on each
/// other.
class ChangeView : public QWidget {
    Q_OBJECT
  public:
    explicit ChangeView(QWidget* parent = nullptr);

    /// The revisions that can be compared with, newest first; `head` is compared with unless the person chose
    /// another.
    void show_revisions(const std::vector<wire::MillRevision>& revisions, std::optional<std::int64_t> head);
    [[nodiscard]] std::optional<std::int64_t> compared_with() const;
    void show(const MillComparison& comparison);
    /// Words in place of a comparison, such as why there is none.
    void say(const QString& words);

  Q_SIGNALS:
    void other_wanted();

  private:
    void open_large();

    QComboBox* m_revisions;
    QLabel *m_title, *m_headline;
    ScaledPicture* m_picture;
    QImage m_large;
    QToolButton* m_more;
    QPlainTextEdit* m_words;
    bool m_chosen = false;
};

}  // namespace weave::studio
