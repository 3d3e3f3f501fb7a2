#include <studio/panels/evidence_box.hpp>

#include <weave/core/file.hpp>

#include <studio/jobs/background.hpp>
#include <studio/panels/plain_label.hpp>
#include <studio/panels/simulation_servers.hpp>
#include <studio/panels/trouble_label.hpp>

#include <QFileDialog>
#include <QGridLayout>
#include <QLocale>
#include <QMenu>
#include <QPushButton>
#include <QToolButton>

#include <string_view>
#include <utility>

namespace weave::studio {

namespace {

template <class Button>
Button* named_button(const char* name, const QString& text, const QString& tip) {
    auto* button = new Button;
    button->setObjectName(name);
    button->setText(text);
    button->setToolTip(tip);
    return button;
}

QString fidelity_words(sim::Fidelity fidelity) {
    const std::string_view name = sim::name_of(fidelity);
    return QString::fromUtf8(name.data(), static_cast<qsizetype>(name.size()));
}

}  // namespace

EvidenceBox::EvidenceBox(QWidget* parent)
    : QWidget(parent),
      m_found_label(plain_label("evidence")),
      m_paper_label(plain_label("signed_evidence")),
      m_trouble(new TroubleLabel),
      m_simulate(named_button<QPushButton>(
          "simulate", tr("Simulate …"),
          tr("Lets the yarns come to rest; a mill may ask for it before it approves"))),
      m_file(named_button<QPushButton>("file_evidence", QString(),
                                       tr("Files what was signed for the revision that the mill has"))),
      m_cancel(named_button<QPushButton>("cancel_evidence", tr("Cancel"),
                                         tr("Ends the simulation on the server"))),
      m_sign(named_button<QToolButton>("sign_evidence", tr("Have it signed"),
                                       tr("A simulation server with a key simulates the whole cloth and "
                                          "signs what it finds, for the mill"))),
      m_menu(new QMenu(this)) {
    m_trouble->setObjectName("evidence_trouble");
    m_sign->setPopupMode(QToolButton::InstantPopup);
    m_sign->setMenu(m_menu);
    m_sign->setMinimumWidth(m_sign->sizeHint().width() + fontMetrics().height());  // its arrow stands beside the words
    // What lies below stays where it is when a run ends: somebody may be about to click there.
    QSizePolicy keeps_its_place = m_simulate->sizePolicy();
    keeps_its_place.setRetainSizeWhenHidden(true);
    m_simulate->setSizePolicy(keeps_its_place);
    m_found_label->setMinimumHeight(2 * fontMetrics().lineSpacing());
    m_found_label->setAlignment(Qt::AlignTop);
    auto* grid = new QGridLayout(this);
    grid->setContentsMargins(0, 0, 0, 0);
    grid->setColumnStretch(0, 1);
    grid->addWidget(m_found_label, 0, 0);
    grid->addWidget(m_simulate, 0, 1, Qt::AlignTop);
    grid->addWidget(m_paper_label, 1, 0);
    auto* column = new QVBoxLayout;
    for (QWidget* button : std::initializer_list<QWidget*>{m_sign, m_cancel, m_file}) {
        button->setSizePolicy(QSizePolicy::MinimumExpanding, QSizePolicy::Fixed);
        column->addWidget(button);
    }
    column->addStretch(1);
    grid->addLayout(column, 1, 1);
    grid->addWidget(m_trouble, 2, 0, 1, 2);
    connect(m_menu, &QMenu::aboutToShow, this, &EvidenceBox::fill_menu);
    connect(m_simulate, &QPushButton::clicked, this, &EvidenceBox::simulation_wanted);
    connect(m_file, &QPushButton::clicked, this, &EvidenceBox::filing_wanted);
    connect(m_cancel, &QPushButton::clicked, this, [this] {
        m_job.cancel();
        m_paper_label->setText(tr("Cancelling …"));
    });
    connect(&m_job, &EvidenceJob::progressed, this,
            [this](const QString& words) { m_paper_label->setText(tr("The server simulates it: %1").arg(words)); });
    connect(&m_job, &EvidenceJob::came, this, &EvidenceBox::set_paper);
    connect(&m_job, &EvidenceJob::failed, this, &EvidenceBox::complain);
    tell();
}

void EvidenceBox::set_design(std::optional<Design> design, std::uint64_t edition) {
    if (!design) {
        m_job.cancel();
        m_found.reset();
        m_paper.reset();
        m_trouble->setText({});
    }
    m_design = std::move(design);
    m_edition = edition;
    tell();
}

void EvidenceBox::set_found(std::optional<SimulationFound> found) {
    m_found = std::move(found);
    tell();
}

void EvidenceBox::set_paper(const SignedPaper& paper, std::uint64_t edition) {
    if (!m_design) return tell();
    m_paper = paper;
    m_paper_edition = edition;
    m_trouble->setText({});
    tell();
}

void EvidenceBox::set_revision(std::optional<std::int64_t> number) {
    m_revision = number;
    tell();
}

const wire::SignedEvidence* EvidenceBox::paper() const {
    return m_paper && m_paper_edition == m_edition ? &m_paper->evidence : nullptr;
}

void EvidenceBox::fill_menu() {
    m_menu->clear();
    for (const ServerWish& server : remembered_servers()) {
        for (const sim::Fidelity fidelity : {sim::Fidelity::standard, sim::Fidelity::reference}) {
            const QString text = tr("Simulate on %1, %2")
                                     .arg(QString::fromStdString(server.host), fidelity_words(fidelity));
            m_menu->addAction(text, this, [this, server, fidelity] { begin(server, fidelity); });
        }
    }
    if (m_menu->isEmpty()) m_menu->addAction(tr("No simulation server is known yet"))->setEnabled(false);
    m_menu->addAction(tr("Simulation servers …"), this, &EvidenceBox::edit_servers);
    m_menu->addSeparator();
    m_menu->addAction(tr("Read signed evidence from a file …"), this, &EvidenceBox::choose_file);
}

void EvidenceBox::edit_servers() {
    auto* dialog = new ServersDialog(remembered_servers(), this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    connect(dialog, &QDialog::accepted, dialog, [dialog] { remember_servers(dialog->servers()); });
    dialog->open();
}

void EvidenceBox::choose_file() {
    const QString path = QFileDialog::getOpenFileName(this, tr("Signed evidence"), {},
                                                      tr("Signed evidence (*.json);;All files (*)"));
    if (!path.isEmpty()) read_file(path);
}

void EvidenceBox::read_file(const QString& path) {
    if (!m_design) return;
    in_background(
        this,
        [path, design = *m_design]() -> Result<SignedPaper> {
            auto bytes = weave::read_file(path.toStdString(), wire::most_evidence);
            if (!bytes) return std::move(bytes).error();
            auto paper = read_paper(*bytes, design);
            if (!paper) return std::move(paper).error().in(path.toStdString());
            return paper;
        },
        [this, edition = m_edition](const Result<SignedPaper>& paper) {
            if (paper) return set_paper(*paper, edition);
            complain(QString::fromStdString(paper.error().text()));
        });
}

void EvidenceBox::begin(const ServerWish& server, sim::Fidelity fidelity) {
    if (!m_design) return;
    m_trouble->setText({});
    m_paper.reset();
    m_job.start(*m_design, m_edition, server, fidelity);
    tell();
    m_paper_label->setText(tr("Asking %1 …").arg(QString::fromStdString(server.host)));
}

void EvidenceBox::complain(const QString& words) {
    m_trouble->setText(words.isEmpty() ? QString() : tr("There is no signed evidence: %1").arg(words));
    tell();
}

void EvidenceBox::tell() {
    const bool runs = m_job.is_running();
    m_found_label->setText(found_words());
    if (!runs) m_paper_label->setText(paper_words());
    m_simulate->setVisible(!m_found || m_found->edition != m_edition || !m_found->at_rest);
    m_sign->setVisible(!runs && paper() == nullptr);
    m_sign->setEnabled(m_design.has_value());
    m_cancel->setVisible(runs);
    m_file->setVisible(paper() != nullptr && m_revision.has_value());
    if (m_revision) m_file->setText(tr("File with revision %1").arg(*m_revision));
}

QString EvidenceBox::found_words() const {
    if (!m_found) return tr("Simulation: none yet; simulate first if your mill asks for it");
    QString words =
        tr("Simulation: relaxed on %1 at %2, %3")
            .arg(m_found->machine, m_found->fidelity, m_found->at_rest ? tr("at rest") : tr("NOT at rest"));
    if (m_found->at.isValid())
        words += tr(" (%1)").arg(QLocale().toString(m_found->at, QLocale::ShortFormat));
    if (!m_found->order_kept) words += tr("; yarns do not lie as the card says");
    if (m_found->edition != m_edition) words += "\n" + tr("The design has changed since. Simulate again.");
    return words;
}

QString EvidenceBox::paper_words() const {
    if (!m_paper) return tr("Nothing is signed: a mill takes what a machine that it knows has signed");
    if (paper() == nullptr) return tr("The design has changed since it was signed: that is not filed");
    const wire::SimulationStatement& said = m_paper->statement;
    QString words = tr("Signed: %1, %2").arg(QString::fromStdString(said.fidelity),
                                             said.converged ? tr("at rest") : tr("NOT at rest"));
    if (!said.order_kept) words += tr("; yarns do not lie as the card says");
    return words + tr("; it is filed with the revision");
}

}  // namespace weave::studio
