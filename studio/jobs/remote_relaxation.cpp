#include <studio/jobs/remote_relaxation.hpp>

#include <studio/jobs/remote_work.hpp>

namespace weave::studio {

Relaxation::Work RemoteRelaxation::work_of(const Design& design, const sim::RunRequest& request) const {
    return [design, request, server = m_server, patience = m_patience](Inbox& inbox, Outbox& outbox) {
        RemoteWork(design, request, server, inbox, outbox).run(patience);
    };
}

}  // namespace weave::studio
