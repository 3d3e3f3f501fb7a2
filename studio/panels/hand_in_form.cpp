#include <studio/panels/hand_in_form.hpp>

#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QPushButton>

#include <studio/panels/trouble_label.hpp>

namespace weave::studio {

namespace {

constexpr int longest_note = 4000;

}  // namespace

HandInForm::HandInForm(QWidget* parent)
    : QWidget(parent),
      m_note(new QPlainTextEdit),
      m_password(new QLineEdit),
      m_save(new QPushButton(tr("Save only"))),
      m_submit(new QPushButton(tr("Save and submit"))),
      m_cancel(new QPushButton(tr("Cancel"))),
      m_warning(new TroubleLabel),
      m_hint(new QLabel),
      m_told(new QLabel),
      m_way(new QLabel),
      m_progress(new QProgressBar) {
    m_note->setObjectName("note");
    m_note->setAccessibleName(tr("Note"));
    m_note->setPlaceholderText(tr("What changed, and what whoever approves it should look at"));
    m_note->setTabChangesFocus(true);
    m_note->setFixedHeight(fontMetrics().height() * 5);
    m_password->setEchoMode(QLineEdit::Password);
    m_password->setInputMethodHints(Qt::ImhHiddenText | Qt::ImhNoPredictiveText);
    m_password->setObjectName("signing_password");
    m_password->setToolTip(
        tr("A submission is signed: your password is typed anew for it. It is kept nowhere"));
    m_save->setObjectName("save_revision");
    m_save->setToolTip(tr("The revision is kept at the mill as a draft; nobody is asked to approve it"));
    m_submit->setObjectName("submit");
    m_submit->setDefault(true);
    m_cancel->setObjectName("cancel_hand_in");
    m_hint->setObjectName("hint");
    m_told->setObjectName("told");
    m_warning->setObjectName("submit_warning");
    m_way->setObjectName("way");
    for (QLabel* label : {m_hint, m_told, m_way})
        label->setWordWrap(true), label->setTextFormat(Qt::PlainText);
    m_hint->setForegroundRole(QPalette::PlaceholderText);
    auto* form = new QFormLayout;
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    form->setFieldGrowthPolicy(QFormLayout::ExpandingFieldsGrow);
    form->addRow(m_note);
    form->addRow(tr("Pass&word, to sign"), m_password);
    auto* buttons = new QHBoxLayout;
    buttons->addStretch();
    buttons->addWidget(m_save);
    buttons->addWidget(m_submit);
    auto* going = new QHBoxLayout;
    going->addWidget(m_progress, 1);
    going->addWidget(m_cancel);
    auto* all = new QVBoxLayout(this);
    all->setContentsMargins(0, 0, 0, 0);
    all->addLayout(form);
    all->addWidget(m_warning);
    all->addLayout(buttons);
    all->addWidget(m_hint);
    all->addWidget(m_way);
    all->addLayout(going);
    all->addWidget(m_told);
    connect(m_note, &QPlainTextEdit::textChanged, this, &HandInForm::judge);
    connect(m_password, &QLineEdit::textChanged, this, &HandInForm::judge);
    connect(m_password, &QLineEdit::returnPressed, m_submit, &QPushButton::click);
    connect(m_save, &QPushButton::clicked, this, [this] { Q_EMIT save_wanted(note()); });
    connect(m_submit, &QPushButton::clicked, this, [this] {
        const QString password = m_password->text();
        m_password->clear();
        Q_EMIT submit_wanted(note(), password);
    });
    connect(m_cancel, &QPushButton::clicked, this, &HandInForm::cancel_wanted);
    set_busy(false);
    tell({});
}

void HandInForm::set_hindrances(const QString& saving, const QString& submitting, const QString& submit) {
    m_no_saving = saving;
    m_no_submitting = submitting;
    m_submit->setText(submit);
    judge();
}

void HandInForm::judge() {
    QString note_lacks;
    if (note().isEmpty())
        note_lacks = tr("Write a note first: what changed?");
    else if (note().size() > longest_note)
        note_lacks = tr("The note is too long: at most %1 letters.").arg(QLocale().toString(longest_note));
    const QString no_saving = m_no_saving.isEmpty() ? note_lacks : m_no_saving;
    QString no_submitting = m_no_submitting.isEmpty() ? note_lacks : m_no_submitting;
    if (no_submitting.isEmpty() && m_password->text().isEmpty())
        no_submitting = tr("Type your password to sign the submission.");
    m_save->setEnabled(!m_busy && no_saving.isEmpty());
    m_submit->setEnabled(!m_busy && no_submitting.isEmpty());
    m_hint->setText(m_busy ? QString() : no_submitting);
    m_hint->setVisible(!m_hint->text().isEmpty());
}

void HandInForm::warn(const QString& words) {
    m_warning->setText(words);
}

void HandInForm::set_busy(bool busy) {
    m_busy = busy;
    m_note->setReadOnly(busy);
    m_password->setReadOnly(busy);  // not disabled: the keys would go to what is next, and so would a password typed again
    m_way->setVisible(busy);
    m_progress->setVisible(busy);
    m_cancel->setVisible(busy);
    m_progress->setRange(0, 0);
    m_way->setText(tr("On its way to the mill …"));
    if (busy) tell({});
    judge();
}

void HandInForm::set_progress(qint64 sent, qint64 of) {
    const QLocale locale;
    if (sent >= of) {  // the mill weaves the document before it answers
        m_progress->setRange(0, 0);
        return m_way->setText(tr("The mill has it and looks at it …"));
    }
    m_progress->setRange(0, 1000);
    m_progress->setValue(static_cast<int>(1000 * sent / of));
    m_way->setText(tr("%1 of %2 sent").arg(locale.formattedDataSize(sent), locale.formattedDataSize(of)));
}

void HandInForm::tell(const QString& words) {
    m_told->setText(words);
    m_told->setVisible(!words.isEmpty());
}

void HandInForm::ask_password() {
    m_password->setFocus();
}

void HandInForm::clear_note() {
    m_note->clear();
}

QString HandInForm::note() const {
    return m_note->toPlainText().trimmed();
}

}  // namespace weave::studio
