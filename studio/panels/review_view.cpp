#include <studio/panels/review_view.hpp>

#include <QComboBox>
#include <QDateTime>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QTextBrowser>

#include <algorithm>
#include <studio/jobs/words.hpp>
#include <studio/panels/approval_flow.hpp>

namespace weave::studio {

namespace {

/// Foreign words in a rich text.
QString safe(const std::string& text) {
    return words(text).toHtmlEscaped().replace('\n', "<br>");
}

/// What somebody did or said, one after another in time.
struct Entry {
    std::string at;
    QString html;
};

QString entry_html(const QString& colour, const QString& what, const std::string& by, const std::string& at,
                   const QString& text) {
    return QString("<p><b style='color:%1'>%2</b> %3 <span style='color:gray'>%4</span><br>%5</p>")
        .arg(colour, what.toHtmlEscaped(), safe(by), time_in_words(at).toHtmlEscaped(), text);
}

}  // namespace

QString time_in_words(const std::string& utc) {
    const QDateTime time = QDateTime::fromString(words(utc), Qt::ISODateWithMs);
    return time.isValid() ? QLocale().toString(time.toLocalTime(), QLocale::ShortFormat) : words(utc);
}

ReviewView::ReviewView(QWidget* parent)
    : QWidget(parent),
      m_revisions(new QComboBox),
      m_flow(new ApprovalFlow),
      m_state(new QLabel),
      m_empty(new QLabel(tr("Nothing of this design is at the mill yet. Once it is saved, its way to the "
                            "loom is shown here, with what others say of it."))),
      m_talk(new QTextBrowser),
      m_comment(new QLineEdit),
      m_send(new QPushButton(tr("Comment"))),
      m_whole(new QWidget) {
    m_revisions->setObjectName("revision");
    m_revisions->setToolTip(tr("The revision whose state is shown"));
    m_revisions->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    m_flow->setObjectName("flow");
    m_state->setObjectName("state");
    m_state->setWordWrap(true);
    m_state->setTextFormat(Qt::PlainText);
    m_state->setTextInteractionFlags(Qt::TextSelectableByMouse);
    m_empty->setWordWrap(true);
    m_talk->setObjectName("talk");
    m_talk->setAccessibleName(tr("Decisions and comments"));
    m_talk->setOpenLinks(false);
    m_talk->setMinimumHeight(fontMetrics().height() * 10);
    m_comment->setObjectName("comment");
    m_comment->setMaxLength(4000);
    m_comment->setPlaceholderText(tr("Say something about this revision"));
    m_send->setObjectName("send_comment");
    auto* say = new QHBoxLayout;
    say->addWidget(m_comment, 1);
    say->addWidget(m_send);
    auto* inner = new QVBoxLayout(m_whole);
    inner->setContentsMargins(0, 0, 0, 0);
    inner->addWidget(m_revisions);
    inner->addWidget(m_flow);
    inner->addWidget(m_state);
    inner->addWidget(m_talk, 1);
    inner->addLayout(say);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    m_empty->setAlignment(Qt::AlignTop);
    all->addWidget(m_empty, 1);
    all->addWidget(m_whole, 100);
    connect(m_revisions, &QComboBox::currentIndexChanged, this, [this] {
        m_review.reset();
        m_state->clear();
        m_talk->clear();
        judge();
        Q_EMIT revision_wanted(number());
    });
    const auto send = [this] {
        if (m_send->isEnabled()) Q_EMIT comment_wanted(*number(), m_comment->text().trimmed());
    };
    connect(m_send, &QPushButton::clicked, this, send);
    connect(m_comment, &QLineEdit::returnPressed, this, send);
    connect(m_comment, &QLineEdit::textChanged, this, &ReviewView::judge);
    clear();
}

void ReviewView::judge() {
    m_send->setEnabled(m_review && m_review->allows("comment") && !m_comment->text().trimmed().isEmpty());
    m_comment->setEnabled(m_review && m_review->allows("comment"));
}

void ReviewView::clear() {
    {
        const QSignalBlocker quiet(m_revisions);
        m_revisions->clear();
    }
    m_history = {};
    m_review.reset();
    m_asked.reset();
    m_whole->setVisible(false);
    m_empty->setVisible(true);
    judge();
}

void ReviewView::show_history(const wire::MillHistory& history, std::optional<std::int64_t> wanted) {
    if (history.revisions.empty()) return clear();
    m_history = history;
    const auto chosen = wanted ? wanted : number();
    {
        const QSignalBlocker quiet(m_revisions);
        m_revisions->clear();
        for (const wire::MillRevision& one : history.revisions)
            m_revisions->addItem(
                tr("Revision %1 — %2 — %3")
                    .arg(one.number)
                    .arg(state_in_words(words(one.state)), words(one.message).section('\n', 0, 0)),
                QVariant::fromValue<qlonglong>(one.number));
        const int found = chosen ? m_revisions->findData(QVariant::fromValue<qlonglong>(*chosen)) : -1;
        m_revisions->setCurrentIndex(std::max(0, found));
    }
    m_empty->setVisible(false);
    m_whole->setVisible(true);
    m_flow->show_state(words(history.revisions[static_cast<std::size_t>(m_revisions->currentIndex())].state));
    if (m_asked == number()) return;
    m_asked = number();
    m_review.reset();
    Q_EMIT revision_wanted(number());
}

std::optional<std::int64_t> ReviewView::number() const {
    const QVariant number = m_revisions->currentData();
    return number.isValid() ? std::optional<std::int64_t>(number.toLongLong()) : std::nullopt;
}

void ReviewView::take_commented() {
    m_comment->clear();
}

// ---- One revision ----

namespace {

QString state_text(const wire::MillReview& review, const wire::MillHistory& history) {
    QStringList lines{ReviewView::tr("Revision %1 is %2.")
                          .arg(review.revision.number)
                          .arg(state_in_words(words(review.revision.state)))};
    for (const wire::MillDecision& decision : review.decisions)
        if (decision.what == "changes requested")
            lines
                << ReviewView::tr("%1 asks for changes: %2").arg(words(decision.by), words(decision.reason));
    for (const wire::MillRelease& release : history.releases)
        if (release.revision == review.revision.number)
            lines << ReviewView::tr("Release %1 for the loom %2: %3")
                         .arg(release.number)
                         .arg(words(release.loom), words(release.state));
    if (review.revision.state == "changes_requested")
        lines << ReviewView::tr("Next: save the changes as a new revision, and submit that one.");
    else
        for (const std::string& missing : review.missing)
            lines << ReviewView::tr("It still lacks: %1").arg(words(missing));
    if (review.revision.state == "submitted")
        lines << ReviewView::tr(
            "A mill keeps what was submitted: nobody can take it back. If it was too early, say so in a "
            "comment and save a better revision.");
    return lines.join('\n');
}

std::vector<Entry> entries_of(const wire::MillReview& review) {
    std::vector<Entry> list{
        {review.revision.at, entry_html("", ReviewView::tr("Saved"), review.revision.author,
                                        review.revision.at, safe(review.revision.message))}};
    if (const auto& step = review.submission)
        list.push_back({step->at, entry_html("#0060a0", ReviewView::tr("Submitted"), step->by, step->at, safe(step->reason))});
    for (const wire::MillDecision& one : review.decisions) {
        const bool approved = one.what == "approved";
        list.push_back({one.at, entry_html(approved ? "#00795a" : "#b34f00",
                                           approved ? ReviewView::tr("✓ Approved")
                                                    : ReviewView::tr("✗ Changes asked for"),
                                           one.by, one.at, safe(one.reason))});
    }
    for (const wire::MillComment& one : review.comments) {
        QStringList place;
        if (one.pick) place << ReviewView::tr("pick %1").arg(*one.pick);
        if (one.end) place << ReviewView::tr("end %1").arg(*one.end);
        const QString at = place.isEmpty() ? QString() : "<i>" + place.join(", ") + ":</i> ";
        list.push_back(
            {one.at, entry_html("#0060a0", ReviewView::tr("Comment"), one.by, one.at, at + safe(one.text))});
    }
    for (const wire::MillEvidence& one : review.evidence) {
        const QString stale =
            one.stale.empty()
                ? QString()
                : "<br><b>" + ReviewView::tr("Does not count: ").toHtmlEscaped() + "</b>" + safe(one.stale);
        const QString kind =
            one.kind == "simulation" ? ReviewView::tr("Simulation") : ReviewView::tr("Held to a loom");
        list.push_back({one.at, entry_html("", kind, one.signer, one.at,
                                           safe(one.covers) + ": " + safe(one.result) + stale)});
    }
    std::stable_sort(list.begin(), list.end(), [](const Entry& a, const Entry& b) { return a.at < b.at; });
    return list;
}

}  // namespace

void ReviewView::show(const wire::MillReview& review) {
    if (number() != review.revision.number) return;
    m_review = review;
    m_flow->show_state(words(review.revision.state));
    m_state->setText(state_text(review, m_history));
    QString html;
    for (const Entry& entry : entries_of(review)) html += entry.html;
    m_talk->setHtml(html);
    m_talk->verticalScrollBar()->setValue(m_talk->verticalScrollBar()->maximum());
    judge();
}

}  // namespace weave::studio
