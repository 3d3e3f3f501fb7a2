#include <studio/panels/sign_in_form.hpp>

#include <QFormLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>

#include <studio/panels/trouble_label.hpp>

namespace weave::studio {

SignInForm::SignInForm(QWidget* parent)
    : QWidget(parent),
      m_origin(new QLineEdit),
      m_fingerprint(new QLineEdit),
      m_name(new QLineEdit),
      m_password(new QLineEdit),
      m_go(new QPushButton(tr("Sign in"))),
      m_words(new TroubleLabel) {
    auto* greeting =
        new QLabel(tr("You are not signed in. A mill keeps every revision of a design and lets others "
                      "approve it; ask your mill's administrator for "
                      "its address, the fingerprint of its certificate, and an invitation. Open the invitation's link in "
                      "a browser and join there, once (or in a terminal: loomlink user join LINK). Then sign in here."));
    greeting->setWordWrap(true);
    greeting->setObjectName("greeting");
    greeting->setTextInteractionFlags(Qt::TextSelectableByMouse);
    m_origin->setPlaceholderText(tr("https://mill:8443"));
    m_origin->setToolTip(tr("The address of the mill's loomlink"));
    m_fingerprint->setPlaceholderText(tr("64 digits, or empty"));
    m_fingerprint->setToolTip(
        tr("SHA-256 of the mill's certificate, as loomlink told it when it started. No other server is "
           "talked to then. Empty: the system's authorities vouch for it"));
    m_name->setToolTip(tr("Your name at the mill"));
    m_password->setEchoMode(QLineEdit::Password);
    m_password->setInputMethodHints(Qt::ImhHiddenText | Qt::ImhNoPredictiveText);
    m_password->setToolTip(tr("It goes to the mill alone and is kept nowhere"));
    m_origin->setObjectName("mill");
    m_fingerprint->setObjectName("fingerprint");
    m_name->setObjectName("person");
    m_password->setObjectName("password");
    m_go->setObjectName("sign_in");
    m_words->setObjectName("sign_in_words");
    auto* all = new QVBoxLayout(this);  // a form would press words of several lines together
    all->setContentsMargins(0, 0, 0, 0);
    auto* form = new QFormLayout;
    form->setRowWrapPolicy(QFormLayout::WrapLongRows);
    form->setFieldGrowthPolicy(QFormLayout::ExpandingFieldsGrow);
    form->addRow(tr("&Mill"), m_origin);
    form->addRow(tr("&Fingerprint"), m_fingerprint);
    form->addRow(tr("&Name"), m_name);
    form->addRow(tr("&Password"), m_password);
    auto* row = new QHBoxLayout;
    row->addStretch();
    row->addWidget(m_go);
    all->addWidget(greeting);
    all->addLayout(form);
    all->addWidget(m_words);
    all->addLayout(row);
    for (QLineEdit* field : {m_origin, m_fingerprint, m_name, m_password}) {
        connect(field, &QLineEdit::textChanged, this, &SignInForm::judge);
        connect(field, &QLineEdit::returnPressed, this, &SignInForm::go);
    }
    connect(m_go, &QPushButton::clicked, this, &SignInForm::go);
    judge();
}

void SignInForm::fill(const QString& origin, const QString& fingerprint, const QString& name) {
    if (m_origin->text().isEmpty()) m_origin->setText(origin);
    if (m_fingerprint->text().isEmpty()) m_fingerprint->setText(fingerprint);
    if (m_name->text().isEmpty()) m_name->setText(name);
}

void SignInForm::complain(const QString& words) {
    m_words->setText(words);
    if (!words.isEmpty()) m_password->setFocus();
}

void SignInForm::set_busy(bool busy) {
    m_busy = busy;
    m_go->setText(busy ? tr("Signing in …") : tr("Sign in"));
    judge();
}

void SignInForm::judge() {
    const bool whole = !m_origin->text().trimmed().isEmpty() && !m_name->text().trimmed().isEmpty() &&
                       !m_password->text().isEmpty();
    m_go->setEnabled(whole && !m_busy);
    m_go->setToolTip(whole ? QString() : tr("Mill, name and password are needed"));
}

void SignInForm::go() {
    if (!m_go->isEnabled()) return;
    complain({});
    const QString password = m_password->text(), origin = m_origin->text().trimmed();
    m_password->clear();
    if (!origin.contains("://") && !origin.startsWith("unix:")) m_origin->setText("https://" + origin);  // what a mill's address is without more words
    Q_EMIT sign_in_wanted(m_origin->text(), TroubleLabel::as_typed(m_fingerprint->text()), m_name->text(), password);
}

}  // namespace weave::studio
