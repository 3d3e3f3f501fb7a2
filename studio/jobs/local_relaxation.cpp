#include <studio/jobs/local_relaxation.hpp>

#include <studio/jobs/local_work.hpp>

namespace weave::studio {

Relaxation::Work LocalRelaxation::work_of(const Design& design, const sim::RunRequest& request) const {
    return [design, request, means = m_means](Inbox& inbox, Outbox& outbox) {
        LocalWork(design, request, means, inbox, outbox).run();
    };
}

}  // namespace weave::studio
