#pragma once

#include <QObject>

#include <studio/document/document.hpp>
#include <studio/panels/findings_panel.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/panels/submit_panel.hpp>

namespace weave::studio {

/// Tells the submit panel of the design, of what the rules say of it and of what a simulation found.
class SubmitDesk : public QObject {
    Q_OBJECT
  public:
    SubmitDesk(SubmitPanel& panel, FindingsPanel& findings, SimulationPanel& simulation, QObject* parent);

    void show_document(Document* document);

  private:
    void tell_design();
    void take_yarns(const std::shared_ptr<const Yarns>& yarns);

    SubmitPanel& m_panel;
    SimulationPanel& m_simulation;
    Document* m_document = nullptr;
};

}  // namespace weave::studio
