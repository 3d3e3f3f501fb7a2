#include <weave/core/log.hpp>

#include <csignal>
#include <exception>
#include <new>
#include <simd/link/error_form.hpp>
#include <simd/worker/work.hpp>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#include <utility>

namespace weave::simd {

namespace {

/// A worker has what it was given: no new rights, no core files with other people's designs, and no life beyond the daemon's.
void renounce(pid_t daemon) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != daemon) ::_exit(1);  // it died before that
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    ::signal(SIGINT, SIG_IGN);  // of a terminal, that means the daemon
    ::signal(SIGTERM, SIG_IGN);
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error like a full disk
}

/// What went wrong, and whether it would go wrong again.
Json failed(const Error& error, bool is_final) {
    return {{"say", "failed"}, {"error", to_json(error)}, {"is_final", is_final}};
}

Status work(Link& link) {
    WEAVE_TRY(const std::optional<LinkMessage> first, link.receive());
    if (!first) return {};
    WEAVE_TRY(WorkOrder order, work_order_from(Json::parse(first->bytes)));
    return Work(link, std::move(order)).run();
}

}  // namespace

int work_for_daemon(int link_number) {
    Link link{Descriptor(link_number)};
    renounce(::getppid());
    try {
        const Status done = work(link);
        if (!done) static_cast<void>(link.send(failed(done.error(), true)));
        return 0;
    } catch (const std::bad_alloc&) {
        static_cast<void>(link.send(failed(system_fault("out of memory: it takes more than it was estimated to"), true)));
    } catch (const std::exception& fault) {
        static_cast<void>(link.send(failed(system_fault(std::string("a fault of the program: ") + fault.what()), false)));
    }
    return 1;
}

}  // namespace weave::simd
