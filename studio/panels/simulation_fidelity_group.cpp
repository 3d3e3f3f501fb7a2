#include <studio/panels/simulation_fidelity_group.hpp>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QSettings>
#include <QVBoxLayout>

#include <algorithm>

namespace weave::studio {

namespace {

const char* const remembered_fidelity = "simulation/fidelity";
const char* const remembered_draft_first = "simulation/draft_first";

/// The seven measured structures that come to rest: Satin E, Twill G, layer to layer, angle interlock A and
/// B, hexagon tubes, TL013 corrected. Seconds: docs/simulation/tradeoff.md, `relax` from the raw start, to
/// the fidelity's own goal. Errors of draft and standard: docs/simulation/README.md, "Errors on the
/// reference's branch"; of reference the rows `reference | relax | reference` there.
QString seconds_source(const QString& points, const QString& goal) {
    return FidelityGroup::tr(
               "Seconds: docs/simulation/tradeoff.md, solver relax from the plan to residual %2, seven "
               "structures of %1 control points, one thread of a busy AMD EPYC of 2 cores.")
        .arg(points, goal);
}

}  // namespace

FidelityWords words_of(sim::Fidelity fidelity) {
    switch (fidelity) {
        case sim::Fidelity::draft:
            return {
                FidelityGroup::tr("Draft"),
                FidelityGroup::tr(
                    "For editing: 2 points a crossing, at rest within 0.01. Small structures took 0.1 to 2.4 "
                    "s. Crimp is off by up to 0.4 points (1.7 on layer to layer), thickness by up to 13 %."),
                seconds_source(FidelityGroup::tr("350 to 2,248"), QStringLiteral("0.01")) +
                    QLatin1Char('\n') +
                    FidelityGroup::tr(
                        "Errors: docs/simulation/README.md, on the reference's branch: draft 0.43 percentage "
                        "points of crimp, 1.7 on layer to layer, thickness 0.0 to 13 %.")};
        case sim::Fidelity::standard:
            return {FidelityGroup::tr("Standard"),
                    FidelityGroup::tr("For judging cloth: 4 points a crossing, at rest within 0.001. Small "
                                      "structures took 0.2 to 3.1 s. Crimp is off by up to 0.1 points (0.5 "
                                      "on layer to layer), thickness by up to 3.4 %."),
                    seconds_source(FidelityGroup::tr("690 to 4,472"), QStringLiteral("0.001")) +
                        QLatin1Char('\n') +
                        FidelityGroup::tr(
                            "Errors: docs/simulation/README.md, on the reference's branch: standard 0.08 "
                            "percentage points of crimp, 0.46 on layer to layer, thickness 0.0 to 3.4 %.")};
        case sim::Fidelity::reference:
            break;
    }
    return {FidelityGroup::tr("Reference"),
            FidelityGroup::tr("For evidence: 8 points a crossing, at rest within 1e-8. Small structures took "
                              "0.7 to 20 s. Crimp is off by up to 0.05 points, thickness by up to 0.3 %."),
            seconds_source(FidelityGroup::tr("1,390 to 9,000"), QStringLiteral("1e-8")) + QLatin1Char('\n') +
                FidelityGroup::tr(
                    "Errors: docs/simulation/tradeoff.md, rows reference, relax, start reference: at most "
                    "0.053 percentage points of crimp and 0.30 % of thickness (layer to layer).")};
}

FidelityGroup::FidelityGroup(QWidget* parent)
    : QGroupBox(tr("Fidelity"), parent),
      m_choice(new QComboBox(this)),
      m_draft_first(new QCheckBox(tr("Start with a &draft first"), this)),
      m_words(new QLabel(this)) {
    for (const sim::Fidelity fidelity :
         {sim::Fidelity::draft, sim::Fidelity::standard, sim::Fidelity::reference}) {
        m_choice->addItem(words_of(fidelity).name, static_cast<int>(fidelity));
        m_choice->setItemData(m_choice->count() - 1, words_of(fidelity).source, Qt::ToolTipRole);
    }
    m_choice->setAccessibleName(tr("Fidelity"));
    m_words->setWordWrap(true);
    m_draft_first->setToolTip(
        tr("Yarns are relaxed in few points first, so there is something to look at after 29 to 52 % of the "
           "time; in all it takes 0.7 to 1.4 times the work.\nSource: docs/simulation/README.md, Starting in "
           "fewer points."));
    auto* lines = new QVBoxLayout(this);
    lines->addWidget(m_choice);
    lines->addWidget(m_words);
    lines->addWidget(m_draft_first);
    const QSettings settings;
    m_choice->setCurrentIndex(std::clamp(
        settings.value(remembered_fidelity, static_cast<int>(sim::Fidelity::draft)).toInt(), 0, 2));
    m_draft_first->setChecked(settings.value(remembered_draft_first, false).toBool());
    show_choice();
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::show_choice);
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::remember);
    connect(m_draft_first, &QCheckBox::toggled, this, &FidelityGroup::remember);
    connect(m_choice, &QComboBox::currentIndexChanged, this, &FidelityGroup::edited);
    connect(m_draft_first, &QCheckBox::toggled, this, &FidelityGroup::edited);
}

sim::Fidelity FidelityGroup::fidelity() const {
    return static_cast<sim::Fidelity>(m_choice->currentData().toInt());
}

/// A reference begins at standard where nothing else is said: sooner as a rule, and its rest is that of
/// standard in finer points (docs/simulation).
std::optional<sim::Fidelity> FidelityGroup::start_from() const {
    if (fidelity() == sim::Fidelity::draft) return {};
    if (m_draft_first->isChecked()) return sim::Fidelity::draft;
    if (fidelity() == sim::Fidelity::reference) return sim::Fidelity::standard;
    return {};
}

void FidelityGroup::show_choice() {
    const FidelityWords words = words_of(fidelity());
    m_words->setText(words.words);
    m_words->setToolTip(words.source);
    m_choice->setToolTip(words.source);
    m_draft_first->setEnabled(fidelity() != sim::Fidelity::draft);
}

void FidelityGroup::remember() const {
    QSettings settings;
    settings.setValue(remembered_fidelity, m_choice->currentIndex());
    settings.setValue(remembered_draft_first, m_draft_first->isChecked());
}

}  // namespace weave::studio
