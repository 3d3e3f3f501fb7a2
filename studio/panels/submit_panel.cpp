#include <studio/panels/submit_panel.hpp>

#include <QHBoxLayout>
#include <QLabel>
#include <QLocale>
#include <QPushButton>
#include <QScrollArea>

#include <algorithm>
#include <studio/panels/approval_flow.hpp>
#include <studio/panels/change_view.hpp>
#include <studio/panels/hand_in_form.hpp>
#include <studio/panels/mill_place.hpp>
#include <studio/panels/plain_label.hpp>
#include <studio/panels/review_view.hpp>
#include <studio/panels/sign_in_form.hpp>
#include <studio/panels/step_box.hpp>
#include <studio/panels/trouble_label.hpp>

namespace weave::studio {

namespace {

constexpr int pause_before_comparing = 400;  // milliseconds: edits come in quick succession

QHBoxLayout* with_button(QLabel* label, QPushButton* button) {
    auto* row = new QHBoxLayout;
    row->addWidget(label, 1);
    row->addWidget(button, 0, Qt::AlignTop);
    return row;
}

}  // namespace

SubmitPanel::SubmitPanel(std::filesystem::path session_file, QWidget* parent)
    : QWidget(parent),
      m_desk(std::move(session_file)),
      m_gone(new TroubleLabel),
      m_trouble(new TroubleLabel),
      m_again(new QPushButton(tr("Try now"))),
      m_where(new StepBox(1, tr("Where"))),
      m_what(new StepBox(2, tr("What"))),
      m_note(new StepBox(3, tr("Note and Submit"))),
      m_place(new MillPlace),
      m_changes(new ChangeView),
      m_size(plain_label("size")),
      m_findings(plain_label("findings_summary")),
      m_evidence(new EvidenceBox),
      m_show_findings(new QPushButton(tr("Show them"))),
      m_form(new HandInForm),
      m_review(new ReviewView) {
    m_where->body()->addWidget(m_place);
    m_what->body()->addWidget(make_what());
    m_note->body()->addWidget(m_form);
    m_note->body()->addWidget(m_trouble);  // below: what a person is about to click or type in stays where it is
    auto* becomes = new QLabel(tr("What becomes of it"));
    QFont bold = font();
    bold.setBold(true);
    becomes->setFont(bold);
    auto* content = new QWidget;
    auto* column = new QVBoxLayout(content);
    column->addWidget(make_troubles());
    for (StepBox* step : {m_where, m_what, m_note}) column->addWidget(step);
    column->addWidget(becomes);
    column->addWidget(m_review, 1);
    auto* area = new QScrollArea;
    area->setWidget(content);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addWidget(area);
    m_soon.setSingleShot(true);
    m_soon.setInterval(pause_before_comparing);
    connect_desk();
    connect_parts();
    take_access();
    tell_what();
}

SubmitPanel::~SubmitPanel() = default;

QWidget* SubmitPanel::make_troubles() {
    auto* all = new QWidget;
    m_gone->setObjectName("gone");
    m_trouble->setObjectName("trouble");
    m_again->setObjectName("try_now");
    m_again->setVisible(false);
    auto* column = new QVBoxLayout(all);
    column->setContentsMargins(0, 0, 0, 0);
    column->addLayout(with_button(m_gone, m_again));
    return all;
}

QWidget* SubmitPanel::make_what() {
    auto* all = new QWidget;
    m_show_findings->setToolTip(tr("The list of findings, each with its place"));
    auto* column = new QVBoxLayout(all);
    column->setContentsMargins(0, 0, 0, 0);
    column->addWidget(m_size);
    column->addWidget(m_changes);
    column->addLayout(with_button(m_findings, m_show_findings));
    column->addWidget(m_evidence);
    return all;
}

void SubmitPanel::connect_desk() {
    connect(&m_desk, &MillDesk::access_changed, this, &SubmitPanel::take_access);
    connect(&m_desk, &MillDesk::designs_told, m_place, &MillPlace::show_designs);
    connect(&m_desk, &MillDesk::design_made, m_place, &MillPlace::take_made);
    connect(&m_desk, &MillDesk::history_told, this, &SubmitPanel::take_history);
    connect(&m_desk, &MillDesk::review_told, m_review, &ReviewView::show);
    connect(&m_desk, &MillDesk::review_told, this, [this](const wire::MillReview& review) {
        if (review.revision.state != "draft" && review.revision.state != "submitted")
            m_form->tell({});  // what was done is history
    });
    connect(&m_desk, &MillDesk::failed, this, &SubmitPanel::take_trouble);
    connect(&m_desk, &MillDesk::commented, m_review, &ReviewView::take_commented);
    connect(&m_desk, &MillDesk::commented, &m_desk, &MillDesk::refresh);
    connect(&m_desk, &MillDesk::progressed, m_form, &HandInForm::set_progress);
    connect(&m_desk, &MillDesk::busy_changed, this, [this](bool busy) {
        m_form->set_busy(busy);
        m_place->setEnabled(!busy);
        if (busy) m_trouble->setText({});
    });
    connect(&m_desk, &MillDesk::reached_changed, this, [this](bool reached) {
        m_gone->setText(reached ? QString()
                                : tr("The mill at %1 does not answer. It is asked again every few seconds; "
                                     "what you wrote stays.")
                                      .arg(m_desk.access().origin));
        m_again->setVisible(!reached);
        if (reached) compare();  // it may have failed for that
        judge();
    });
    connect(&m_desk, &MillDesk::compared, this, [this](const MillComparison& comparison) {
        m_comparison = comparison;
        m_not_comparable.reset();
        m_changes->show(comparison);
        judge();
    });
    connect(&m_desk, &MillDesk::saved, this, [this](const QString& design, qint64 number) {
        m_just_saved = number;
        if (!m_submits) m_form->clear_note();  // a submission that is refused is tried again with it
        m_form->tell(tr("Saved as revision %1 of %2.").arg(number).arg(design));
    });
    connect(&m_desk, &MillDesk::submitted, this, [this](qint64 number, const QString& state) {
        m_form->clear_note();
        m_form->tell(tr("Revision %1: %2.").arg(number).arg(state_in_words(state)));
    });
    connect(&m_desk, &MillDesk::evidence_filed, this,
            [this](qint64 number) { m_form->tell(tr("The evidence is filed with revision %1.").arg(number)); });
    connect(&m_desk, &MillDesk::handed_in, &m_desk, &MillDesk::refresh);
}

void SubmitPanel::connect_parts() {
    connect(&m_soon, &QTimer::timeout, this, &SubmitPanel::compare);
    connect(m_again, &QPushButton::clicked, &m_desk, &MillDesk::refresh);
    connect(&m_place->form(), &SignInForm::sign_in_wanted, this,
            [this](const QString& origin, const QString& fingerprint, const QString& name,
                   const QString& password) {
                m_place->form().set_busy(true);
                m_desk.sign_in(origin, fingerprint, name, password);
            });
    connect(m_place, &MillPlace::sign_out_wanted, &m_desk, &MillDesk::sign_out);
    connect(m_place, &MillPlace::design_changed, this, &SubmitPanel::take_design_choice);
    connect(m_place, &MillPlace::branch_changed, this, [this] {
        if (m_history) take_history(*m_history);
    });
    connect(m_changes, &ChangeView::other_wanted, this, &SubmitPanel::compare);
    connect(m_form, &HandInForm::save_wanted, this,
            [this](const QString& note) { hand_in(false, note, {}); });
    connect(m_form, &HandInForm::submit_wanted, this,
            [this](const QString& note, const QString& password) { hand_in(true, note, password); });
    connect(m_form, &HandInForm::cancel_wanted, &m_desk, &MillDesk::cancel);
    connect(m_review, &ReviewView::revision_wanted, &m_desk, &MillDesk::review);
    connect(m_review, &ReviewView::comment_wanted, &m_desk, &MillDesk::comment);
    connect(m_show_findings, &QPushButton::clicked, this, &SubmitPanel::findings_wanted);
    connect(m_evidence, &EvidenceBox::simulation_wanted, this, &SubmitPanel::simulation_wanted);
    connect(m_evidence, &EvidenceBox::filing_wanted, this, &SubmitPanel::file_evidence);
}

// ---- From the owner ----

void SubmitPanel::set_design(const Design& design, BlockPtr cloth, std::uint64_t edition) {
    const bool is_other = edition != m_edition || !m_design;
    m_cloth = std::move(cloth);
    m_evidence->set_design(design, edition);
    if (is_other) {
        m_design = design;
        m_edition = edition;
        if (m_comparison && m_comparison->same)
            m_changes->say(tr("Comparing with revision %1 …").arg(m_comparison->number));
        compare_soon();
    }
    tell_what();
    judge();
}

void SubmitPanel::clear_design() {
    m_design.reset();
    m_cloth.reset();
    m_comparison.reset();
    m_not_comparable.reset();
    m_desk.forget_comparison();
    m_has_findings = false;
    m_evidence->set_design({}, m_edition);
    tell_what();
    judge();
}

void SubmitPanel::suggest_name(const QString& name) {
    m_place->suggest(name);
}

void SubmitPanel::suggest_anew(const QString& name) {
    m_place->suggest_anew(name);
}

void SubmitPanel::set_findings(std::size_t errors, std::size_t warnings, const QString& text) {
    m_errors = errors;
    m_warnings = warnings;
    m_findings_text = text;
    m_has_findings = true;
    tell_what();
    judge();
}

void SubmitPanel::forget_findings() {
    m_has_findings = false;
    tell_what();
    judge();
}

void SubmitPanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    m_desk.watch(true);
    if (!std::exchange(m_looked_in, true)) return m_desk.look_in();
    if (m_desk.access().signed_in) m_desk.refresh();
    compare_soon();
}

void SubmitPanel::hideEvent(QHideEvent* event) {
    QWidget::hideEvent(event);
    m_desk.watch(false);
}

// ---- From the mill ----

void SubmitPanel::take_access() {
    const MillAccess& access = m_desk.access();
    m_place->form().set_busy(false);
    m_place->show_access(access);
    m_where->say(access.signed_in ? QString() : tr("not signed in"));
    for (QWidget* part : {static_cast<QWidget*>(m_note), static_cast<QWidget*>(m_review)})
        part->setEnabled(access.signed_in);
    if (access.signed_in) {
        m_trouble->setText({});
        m_place->form().complain({});
        m_desk.list_designs();
        take_design_choice();
    } else {
        m_history.reset();
        m_comparison.reset();
        m_not_comparable.reset();
        m_review->clear();
        m_changes->show_revisions({}, {});
        m_changes->say(tr("Sign in to see what changed since the last revision."));
    }
    judge();
}

void SubmitPanel::take_design_choice() {
    m_history.reset();
    m_comparison.reset();
    m_not_comparable.reset();
    m_just_saved.reset();
    m_trouble->setText({});
    m_review->clear();
    m_changes->show_revisions({}, {});
    const QString name = m_place->is_new() ? QString() : m_place->design();
    m_desk.open(m_desk.access().signed_in ? name : QString());
    m_changes->say(name.isEmpty() ? tr("A new design: all of it is new to the mill.")
                                  : tr("Looking up the last revision …"));
    judge();
}

void SubmitPanel::take_history(const wire::MillHistory& history) {
    m_history = history;
    m_not_comparable.reset();
    m_place->show_newest(history);
    m_place->show_branches(history.branches);
    m_changes->show_revisions(history.revisions, history.head_of(m_place->branch().toStdString()));
    m_review->show_history(history, std::exchange(m_just_saved, std::nullopt));
    compare();
    judge();
}

void SubmitPanel::take_trouble(const MillTrouble& trouble) {
    m_place->form().set_busy(false);
    if (trouble.unreachable && trouble.task != MillTask::sign_in && trouble.task != MillTask::hand_in &&
        trouble.task != MillTask::comment)
        return;
    if (!m_desk.access().signed_in) {
        const bool ended = trouble.task != MillTask::sign_in && trouble.task != MillTask::look_in;
        return m_place->form().complain(
            ended ? tr("Your session at the mill has ended. Sign in again; what you wrote stays.")
                  : trouble.words);
    }
    if (trouble.given_up)
        return m_trouble->setText(
            tr("Cancelled. If the mill had all of it already, the revision shows below."));
    if (trouble.task == MillTask::compare) {
        m_not_comparable = m_edition;
        m_changes->say(tr("The revision cannot be compared: %1").arg(trouble.words));
        return judge();
    }
    if (trouble.task == MillTask::hand_in) {
        m_trouble->setText(tr("The mill did not take it: %1").arg(trouble.words));
        if (m_submits) m_form->ask_password();
        return m_desk.refresh();
    }
    if (trouble.task == MillTask::evidence)
        return m_trouble->setText(tr("The mill did not take the evidence: %1").arg(trouble.words));
    m_trouble->setText(trouble.words);
}

// ---- Comparing ----

void SubmitPanel::compare_soon() {
    if (isVisible()) m_soon.start();
}

void SubmitPanel::compare() {
    const auto number = m_changes->compared_with();
    if (!m_design || !m_desk.access().signed_in || !m_history) return;
    if (!number) return m_changes->say(tr("The design has no revision yet: all of it is new to the mill."));
    if (m_comparison && m_comparison->number == *number && m_comparison->edition == m_edition) return;
    m_desk.compare(*m_design, m_edition, *number);
}

const wire::MillRevision* SubmitPanel::head() const {
    if (!m_history) return nullptr;
    const auto number = m_history->head_of(m_place->branch().toStdString());
    const auto& list = m_history->revisions;
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const wire::MillRevision& one) { return one.number == number; });
    return found == list.end() ? nullptr : &*found;
}

std::optional<bool> SubmitPanel::is_saved() const {
    if (m_place->is_new() || (m_history && head() == nullptr)) return false;
    if (m_not_comparable == m_edition) return false;  // what nobody can read keeps nobody from going on
    if (!m_comparison || !m_history || m_comparison->edition != m_edition) return {};
    if (m_comparison->number != head()->number)
        return false;  // the person compares with an older one; the mill knows
    return m_comparison->same;
}

// ---- Handing in ----

void SubmitPanel::hand_in(bool submits, const QString& note, const QString& password) {
    if (!m_design) return;
    MillHandIn wish;
    wish.design = m_place->design();
    wish.is_new = m_place->is_new();
    wish.branch = m_place->branch();
    if (const wire::MillRevision* newest = head()) wish.expected = newest->number;
    if (is_saved().value_or(false))
        wish.revision = wish.expected;
    else
        wish.document = *m_design;
    if (const auto* paper = m_evidence->paper()) wish.evidence.push_back(*paper);
    wish.note = note;
    wish.submits = m_submits = submits;
    wish.password = password;
    m_desk.hand_in(std::move(wish));
}

/// For the revision that holds the design already.
void SubmitPanel::file_evidence() {
    if (!is_saved().value_or(false) || m_evidence->paper() == nullptr) return;
    MillHandIn wish;
    wish.design = m_place->design();
    wish.branch = m_place->branch();
    wish.revision = head()->number;
    wish.evidence.push_back(*m_evidence->paper());
    m_desk.hand_in(std::move(wish));
}

QString SubmitPanel::no_saving() const {
    if (!m_desk.access().signed_in) return tr("Sign in first.");
    if (!m_desk.access().may_design())
        return tr("Your roles at the mill do not let you save: a designer does.");
    if (!m_desk.is_reached()) return tr("The mill does not answer.");
    if (!m_design) return tr("No design is open.");
    if (!m_cloth) return tr("The design makes no cloth yet; a mill takes what can be woven.");
    if (m_place->design().isEmpty()) return tr("Give the design a name at the mill.");
    const auto saved = is_saved();
    if (!saved) return tr("The open design is being compared with the last revision …");
    if (*saved) return tr("Nothing to save: revision %1 holds this design.").arg(head()->number);
    return {};
}

QString SubmitPanel::no_submitting() const {
    const auto saved = is_saved();
    if (!saved.value_or(false) || !m_desk.is_reached() || !m_desk.access().may_design()) return no_saving();
    if (head()->state != "draft")
        return tr("Revision %1 holds this design: %2.")
            .arg(head()->number)
            .arg(state_in_words(QString::fromStdString(head()->state)));
    return {};
}

void SubmitPanel::judge() {
    const bool saved = is_saved().value_or(false);
    m_evidence->set_revision(saved ? std::optional(head()->number) : std::nullopt);
    m_form->set_hindrances(no_saving(), no_submitting(),
                           saved ? tr("Submit revision %1").arg(head()->number) : tr("Save and submit"));
    m_form->warn(m_errors == 0 || !m_has_findings
                     ? QString()
                     : tr("The design has %n error(s). The mill may keep a submission that has errors, but "
                          "nobody can approve it until they are gone or let pass.",
                          nullptr, static_cast<int>(m_errors)));
}

void SubmitPanel::tell_what() {
    if (!m_design)
        m_size->setText(tr("No design is open."));
    else if (!m_cloth)
        m_size->setText(tr("The design makes no cloth yet."));
    else
        m_size->setText(tr("The open design: %1, %2")
                            .arg(tr("%Ln pick(s)", nullptr, static_cast<int>(m_cloth->picks())),
                                 tr("%Ln end(s)", nullptr, static_cast<int>(m_cloth->ends()))));
    m_findings->setText(m_has_findings ? tr("Findings: %1").arg(m_findings_text) : tr("Findings: not looked for yet"));
    m_show_findings->setVisible(m_has_findings && m_errors + m_warnings > 0);
}

}  // namespace weave::studio
