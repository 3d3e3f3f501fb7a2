#include <studio/panels/mill_place.hpp>

#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpression>
#include <QSignalBlocker>
#include <QUrl>

#include <algorithm>
#include <studio/jobs/words.hpp>
#include <studio/panels/approval_flow.hpp>
#include <studio/panels/plain_tip.hpp>
#include <studio/panels/sign_in_form.hpp>

namespace weave::studio {

namespace {

/// The names that a mill takes; the mill itself has the last word.
const QRegularExpression& name_pattern() {
    static const QRegularExpression pattern("^[A-Za-z0-9_](?:[A-Za-z0-9._-]{0,62}[A-Za-z0-9_-])?$");
    return pattern;
}

/// A title or a file's name as a name for a mill.
QString name_from(const QString& title) {
    QString name;
    for (const QChar letter : title.normalized(QString::NormalizationForm_KD)) {
        if (letter.category() == QChar::Mark_NonSpacing) continue;
        const bool fits = (letter.unicode() < 128 && letter.isLetterOrNumber()) || letter == '_' ||
                          letter == '.' || letter == '-';
        if (fits)
            name += letter;
        else if (!name.isEmpty() && !name.endsWith('-'))
            name += '-';
    }
    while (name.startsWith('.') || name.startsWith('-')) name.remove(0, 1);
    name.truncate(64);
    while (name.endsWith('.') || name.endsWith('-')) name.chop(1);
    return name;
}

/// A design in the list, with what has become of its newest revision.
QString entry_of(const wire::MillDesign& design) {
    const QString state = design.newest ? MillPlace::tr("revision %1, %2").arg(*design.newest).arg(state_in_words(words(design.state)))
                                        : MillPlace::tr("no revision yet");
    return MillPlace::tr("%1 — %2").arg(words(design.name), state);
}

/// Typed spaces are hyphens: a name at a mill has none.
class NameValidator : public QRegularExpressionValidator {
  public:
    explicit NameValidator(QObject* parent) : QRegularExpressionValidator(QRegularExpression("[A-Za-z0-9._-]{0,64}"), parent) {}
    State validate(QString& text, int& cursor) const override {
        text.replace(' ', '-');
        return QRegularExpressionValidator::validate(text, cursor);
    }
};

}  // namespace

MillPlace::MillPlace(QWidget* parent)
    : QWidget(parent),
      m_form(new SignInForm),
      m_place(new QWidget),
      m_who(new QLabel),
      m_branch_title(new QLabel(tr("&Branch"))),
      m_name_title(new QLabel(tr("N&ew name"))),
      m_designs(new QComboBox),
      m_branches(new QComboBox),
      m_name(new QLineEdit) {
    m_who->setTextFormat(Qt::PlainText);
    m_who->setWordWrap(true);
    m_who->setObjectName("who");
    m_designs->setObjectName("design");
    m_designs->setToolTip(tr("The design at the mill that this is a revision of"));
    m_designs->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    for (QComboBox* list : {m_designs, m_branches})
        list->setMinimumContentsLength(12), list->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    m_name->setObjectName("new_design");
    m_name->setValidator(new NameValidator(m_name));
    m_name->setToolTip(tr("Letters a to z, digits, point, hyphen and underscore; at most 64"));
    m_branches->setObjectName("branch");
    m_branches->setToolTip(tr("The branch of the design that the revision goes on"));
    auto* out = new QPushButton(tr("Sign out"));
    out->setObjectName("sign_out");
    auto* person = new QHBoxLayout;
    person->addWidget(m_who, 1);
    person->addWidget(out);
    auto* rows = new QFormLayout(m_place);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setRowWrapPolicy(QFormLayout::WrapLongRows);
    rows->setFieldGrowthPolicy(QFormLayout::ExpandingFieldsGrow);
    rows->addRow(person);
    rows->addRow(tr("&Design"), m_designs);
    m_name_title->setBuddy(m_name);
    m_branch_title->setBuddy(m_branches);
    rows->addRow(m_name_title, m_name);
    rows->addRow(m_branch_title, m_branches);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addWidget(m_form);
    all->addWidget(m_place);
    connect(out, &QPushButton::clicked, this, &MillPlace::sign_out_wanted);
    connect(m_designs, &QComboBox::currentIndexChanged, this, [this] {
        m_name->setVisible(is_new());
        m_name_title->setVisible(is_new());
        if (is_new()) show_branches({});
        Q_EMIT design_changed();
    });
    connect(m_designs, &QComboBox::activated, this, [this] {
        m_chosen = true;
        if (is_new()) m_name->setFocus();
    });
    connect(m_name, &QLineEdit::textEdited, this, [this] { m_chosen = true; });
    connect(m_name, &QLineEdit::textChanged, this, &MillPlace::design_changed);
    connect(m_branches, &QComboBox::activated, this, &MillPlace::branch_changed);
    show_branches({});
    show_access({});
}

void MillPlace::show_access(const MillAccess& access) {
    m_form->setVisible(!access.signed_in);
    m_place->setVisible(access.signed_in);
    m_form->fill(access.origin, access.fingerprint, access.name);
    const QUrl url(access.origin);
    const QString mill = url.port() > 0 ? tr("%1, port %2").arg(url.host()).arg(url.port()) : access.origin;
    m_who->setText(tr("%1 at %2").arg(access.full_name.isEmpty() ? access.name : access.full_name, mill));
    m_who->setToolTip(plain_tip(tr("%1, signed in as %2: %3").arg(access.origin, access.name, access.roles.join(", "))));
    if (access.signed_in && m_designs->count() == 0) fill({});
}

// ---- Designs ----

void MillPlace::show_designs(const std::vector<wire::MillDesign>& designs) {
    m_known = designs;
    fill(m_chosen || !is_new() ? design() : QString());
}

void MillPlace::show_newest(const wire::MillHistory& history) {
    const auto known = std::find_if(m_known.begin(), m_known.end(), [&](const wire::MillDesign& one) { return one.name == history.design; });
    const auto newest = std::max_element(history.revisions.begin(), history.revisions.end(),
                                         [](const auto& one, const auto& other) { return one.number < other.number; });
    if (known == m_known.end() || newest == history.revisions.end()) return;
    known->newest = newest->number;
    known->state = newest->state;
    m_designs->setItemText(m_designs->findData(words(known->name)), entry_of(*known));
}

void MillPlace::fill(const QString& chosen) {
    const bool was_new = is_new();
    const QString typed = m_name->text(), meant = design();
    {
        const QSignalBlocker quiet(m_designs), quiet_name(m_name);
        m_designs->clear();
        for (const wire::MillDesign& design : m_known) m_designs->addItem(entry_of(design), words(design.name));
        m_designs->addItem(tr("A new design …"));
        if (m_chosen && was_new)
            m_designs->setCurrentIndex(m_designs->count() - 1), m_name->setText(typed);
        else
            choose(chosen.isEmpty() ? m_suggested : chosen);
    }
    m_name->setVisible(is_new());
    m_name_title->setVisible(is_new());
    if (design() != meant || is_new() != was_new) Q_EMIT design_changed();
}

void MillPlace::choose(const QString& name) {
    const int found = name.isEmpty() ? -1 : m_designs->findData(name);
    m_designs->setCurrentIndex(found >= 0 ? found : m_designs->count() - 1);
    if (found < 0) m_name->setText(name);
}

void MillPlace::suggest_anew(const QString& name) {
    if (!m_chosen) return suggest(name);
    m_suggested = name_from(name);
}

void MillPlace::suggest(const QString& name) {
    m_suggested = name_from(name);
    m_chosen = false;
    if (m_designs->count() > 0) choose(m_suggested);
}

void MillPlace::take_made(const QString& name) {
    if (m_designs->findData(name) < 0) m_known.push_back({name.toStdString(), {}, {}});
    m_chosen = false;
    m_suggested = name;
    fill(name);
}

bool MillPlace::is_new() const {
    return m_designs->count() == 0 || m_designs->currentIndex() == m_designs->count() - 1;
}

QString MillPlace::design() const {
    if (!is_new()) return m_designs->currentData().toString();
    return name_pattern().match(m_name->text()).hasMatch() ? m_name->text() : QString();
}

// ---- Branches ----

void MillPlace::show_branches(const std::vector<wire::MillBranch>& branches) {
    const QString was = branch();
    m_branches->clear();
    for (const wire::MillBranch& one : branches)
        m_branches->addItem(tr("%1 — at revision %2").arg(words(one.name)).arg(one.head), words(one.name));
    const int found = m_branches->findData(was);
    if (found >= 0) m_branches->setCurrentIndex(found);
    m_branches->setVisible(branches.size() > 1);
    m_branch_title->setVisible(branches.size() > 1);
}

QString MillPlace::branch() const {
    const QString name = m_branches->currentData().toString();
    return name.isEmpty() ? QString(wire::main_branch) : name;
}

}  // namespace weave::studio
