// A clock of the day that is set forth and back by a day at every look, for programs that it is loaded into before others; or that is
// ahead by as many seconds as WEAVE_CLOCK_AHEAD_S says. Clocks that only count on are left alone.

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

long jump() {
    static std::atomic<unsigned> looks{0};
    static const char* const ahead = std::getenv("WEAVE_CLOCK_AHEAD_S");
    if (ahead != nullptr) return std::strtol(ahead, nullptr, 10);
    return looks.fetch_add(1) % 2 == 0 ? 86400 : -86400;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    const auto result = static_cast<int>(::syscall(SYS_clock_gettime, clock, time));
    if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += jump();
    return result;
}

extern "C" time_t time(time_t* into) noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    if (into != nullptr) *into = now.tv_sec;
    return now.tv_sec;
}
