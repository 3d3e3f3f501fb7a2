#include <studio/panels/change_view.hpp>

#include <QComboBox>
#include <QDialog>
#include <QFontDatabase>
#include <QHBoxLayout>
#include <QLabel>
#include <QPlainTextEdit>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QToolButton>

#include <studio/panels/approval_flow.hpp>
#include <studio/panels/scaled_picture.hpp>

namespace weave::studio {

ChangeView::ChangeView(QWidget* parent)
    : QWidget(parent),
      m_revisions(new QComboBox),
      m_title(new QLabel(tr("&Compared with"))),
      m_headline(new QLabel),
      m_picture(new ScaledPicture),
      m_more(new QToolButton),
      m_words(new QPlainTextEdit) {
    m_title->setBuddy(m_revisions);
    m_revisions->setObjectName("compare_with");
    m_revisions->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_headline->setObjectName("changes");
    m_headline->setWordWrap(true);
    m_headline->setTextFormat(Qt::PlainText);
    m_picture->setObjectName("change_picture");
    m_more->setText(tr("All changes in words"));
    m_more->setObjectName("all_changes");
    m_more->setCheckable(true);
    m_more->setAutoRaise(true);
    m_more->setArrowType(Qt::RightArrow);
    m_more->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    m_words->setReadOnly(true);
    m_words->setObjectName("change_words");
    m_words->setAccessibleName(tr("All changes in words"));
    m_words->setFont(QFontDatabase::systemFont(QFontDatabase::FixedFont));
    m_words->setLineWrapMode(QPlainTextEdit::NoWrap);
    m_words->setFixedHeight(fontMetrics().height() * 12);
    auto* top = new QHBoxLayout;
    top->addWidget(m_title);
    top->addWidget(m_revisions, 1);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addLayout(top);
    all->addWidget(m_headline);
    all->addWidget(m_picture);
    all->addWidget(m_more);
    all->addWidget(m_words);
    connect(m_more, &QToolButton::toggled, this, [this](bool open) {
        m_words->setVisible(open);
        m_more->setArrowType(open ? Qt::DownArrow : Qt::RightArrow);
    });
    connect(m_revisions, &QComboBox::activated, this, [this] {
        m_chosen = true;
        Q_EMIT other_wanted();
    });
    connect(m_picture, &ScaledPicture::large_wanted, this, &ChangeView::open_large);
    show_revisions({}, {});
    say({});
}

void ChangeView::show_revisions(const std::vector<wire::MillRevision>& revisions,
                                std::optional<std::int64_t> head) {
    const auto was = m_chosen ? compared_with() : std::nullopt;
    const QSignalBlocker quiet(m_revisions);
    m_revisions->clear();
    for (const wire::MillRevision& one : revisions) {
        const QString message = QString::fromStdString(one.message).section('\n', 0, 0);
        m_revisions->addItem(tr("Revision %1 — %2").arg(one.number).arg(message),
                             QVariant::fromValue<qlonglong>(one.number));
    }
    const auto wanted = was ? was : head;
    const int found = wanted ? m_revisions->findData(QVariant::fromValue<qlonglong>(*wanted)) : -1;
    m_chosen = m_chosen && found >= 0;
    m_revisions->setCurrentIndex(found >= 0 ? found : revisions.empty() ? -1 : 0);
    m_revisions->setVisible(!revisions.empty());
    m_title->setVisible(!revisions.empty());
}

std::optional<std::int64_t> ChangeView::compared_with() const {
    const QVariant number = m_revisions->currentData();
    return number.isValid() ? std::optional<std::int64_t>(number.toLongLong()) : std::nullopt;
}

void ChangeView::show(const MillComparison& comparison) {
    QString words = comparison.headline;
    if (comparison.same)
        words = tr("The open design is what revision %1 holds.").arg(comparison.number);
    else if (words.isEmpty())
        words = tr("The cards are the same; other parts of the design differ.");
    m_headline->setText(words);
    m_picture->set_image(comparison.small_picture);
    m_large = comparison.picture;
    m_words->setPlainText(comparison.words);
    m_more->setVisible(!comparison.same);
    m_words->setVisible(!comparison.same && m_more->isChecked());
}

void ChangeView::say(const QString& words) {
    m_headline->setText(words);
    m_picture->set_image({});
    m_words->clear();
    m_words->setVisible(false);
    m_more->setVisible(false);
}

/// A window beside the others, which holds nothing up.
void ChangeView::open_large() {
    auto* window = new QDialog(this);
    window->setAttribute(Qt::WA_DeleteOnClose);
    window->setWindowTitle(tr("Changes since revision %1").arg(compared_with().value_or(0)));
    auto* picture = new QLabel;
    picture->setPixmap(QPixmap::fromImage(m_large));
    auto* area = new QScrollArea;
    area->setWidget(picture);
    area->setAlignment(Qt::AlignCenter);
    auto* all = new QVBoxLayout(window);
    all->setContentsMargins(0, 0, 0, 0);
    all->addWidget(area);
    const int line = fontMetrics().height();
    window->resize(m_large.size().boundedTo(QSize(line * 60, line * 45)) +
                   QSize(line * 2, line * 2));
    window->show();
}

}  // namespace weave::studio
