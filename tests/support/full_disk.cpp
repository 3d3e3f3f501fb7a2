// A disk that is full for as long as the file that WEAVE_FULL_DISK names is there, for a server that it is loaded into before others:
// no file of its tables grows. Its journal is on another disk, as it should be.

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

bool is_of_tables(int file) {
    char link[64], path[PATH_MAX];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t size = ::readlink(link, path, sizeof path - 1);
    if (size <= 0) return false;
    path[size] = '\0';
    return std::strstr(path, "/base/") != nullptr;
}

bool is_full(int file, off_t end) {
    const char* const flag = std::getenv("WEAVE_FULL_DISK");
    struct stat facts {};
    return flag != nullptr && ::access(flag, F_OK) == 0 && is_of_tables(file) && ::fstat(file, &facts) == 0 && end > facts.st_size;
}

}  // namespace

extern "C" ssize_t pwrite(int file, const void* bytes, size_t size, off_t place) {
    if (is_full(file, place + static_cast<off_t>(size))) {
        errno = ENOSPC;
        return -1;
    }
    return ::syscall(SYS_pwrite64, file, bytes, size, place);
}

extern "C" ssize_t pwrite64(int file, const void* bytes, size_t size, off_t place) {
    return pwrite(file, bytes, size, place);
}
