#include <support/fault_vfs.hpp>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace weave::testing {

namespace {

FaultDisk* g_disk = nullptr;
sqlite3_vfs* g_real = nullptr;
sqlite3_vfs g_vfs;
sqlite3_io_methods g_methods;

}  // namespace

/// Behind it, in the same piece of memory, lies the file of the system's VFS.
class FaultDisk::File {
  public:
    sqlite3_file base;
    std::string* path;  // none for a temporary file
    [[nodiscard]] sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
    static File& of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
};

namespace {

using File = FaultDisk::File;

sqlite3_file* real(sqlite3_file* file) {
    return File::of(file).real();
}

int close_file(sqlite3_file* file) {
    File& own = File::of(file);
    if (own.path != nullptr) g_disk->closed(*own.path, own.real());
    delete own.path;
    return real(file)->pMethods->xClose(real(file));
}
int read_file(sqlite3_file* file, void* data, int count, sqlite3_int64 offset) {
    return real(file)->pMethods->xRead(real(file), data, count, offset);
}
int write_file(sqlite3_file* file, const void* data, int count, sqlite3_int64 offset) {
    return g_disk->write(File::of(file), data, count, offset);
}
int truncate_file(sqlite3_file* file, sqlite3_int64 size) {
    return g_disk->truncate(File::of(file), size);
}
int sync_file(sqlite3_file* file, int flags) {
    return g_disk->sync(File::of(file), flags);
}
int file_size(sqlite3_file* file, sqlite3_int64* size) {
    return real(file)->pMethods->xFileSize(real(file), size);
}
int lock_file(sqlite3_file* file, int level) {
    return real(file)->pMethods->xLock(real(file), level);
}
int unlock_file(sqlite3_file* file, int level) {
    return real(file)->pMethods->xUnlock(real(file), level);
}
int check_lock(sqlite3_file* file, int* held) {
    return real(file)->pMethods->xCheckReservedLock(real(file), held);
}
int control_file(sqlite3_file* file, int operation, void* argument) {
    if (operation == SQLITE_FCNTL_PRAGMA && g_disk->forgets_full()) {
        char** words = static_cast<char**>(argument);
        if (sqlite3_stricmp(words[1], "synchronous") == 0 && words[2] != nullptr &&
            sqlite3_stricmp(words[2], "full") == 0)
            return SQLITE_OK;
    }
    return real(file)->pMethods->xFileControl(real(file), operation, argument);
}
int sector_size(sqlite3_file*) {
    return 512;
}
int characteristics(sqlite3_file*) {
    return 0;  // no promise: neither atomic writes nor safe appending nor that a write spares its neighbours
}
int map_shm(sqlite3_file* file, int page, int size, int extend, void volatile** memory) {
    return real(file)->pMethods->xShmMap(real(file), page, size, extend, memory);
}
int lock_shm(sqlite3_file* file, int offset, int count, int flags) {
    return real(file)->pMethods->xShmLock(real(file), offset, count, flags);
}
void barrier_shm(sqlite3_file* file) {
    real(file)->pMethods->xShmBarrier(real(file));
}
int unmap_shm(sqlite3_file* file, int remove) {
    return real(file)->pMethods->xShmUnmap(real(file), remove);
}

int open_file(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
    File& own = File::of(file);
    own.base.pMethods = nullptr;
    own.path = nullptr;
    const int code = g_real->xOpen(g_real, name, own.real(), flags, out_flags);
    if (code != SQLITE_OK) return code;
    own.base.pMethods = &g_methods;
    if (name != nullptr) {
        own.path = new std::string(name);
        g_disk->opened(*own.path, own.real());
    }
    return code;
}
int delete_file(sqlite3_vfs*, const char* name, int flags) {
    return g_disk->remove(name, flags, g_real);
}

int ask_for_normal(sqlite3* handle, char**, const sqlite3_api_routines*) {
    return sqlite3_exec(handle, "PRAGMA synchronous = NORMAL", nullptr, nullptr, nullptr);
}
using Extension = void (*)();
Extension normal_extension() {
    return reinterpret_cast<Extension>(ask_for_normal);
}

void fill_methods() {
    g_methods = {2,         close_file,  read_file,  write_file,   truncate_file, sync_file,       file_size,
                 lock_file, unlock_file, check_lock, control_file, sector_size,   characteristics, map_shm,
                 lock_shm,  barrier_shm, unmap_shm,  nullptr,      nullptr};
}

}  // namespace

FaultDisk::FaultDisk(bool forget_full) : m_forget_full(forget_full) {
    if (g_disk != nullptr) throw std::logic_error("there is one disk at a time");
    g_disk = this;
    g_real = sqlite3_vfs_find(nullptr);
    fill_methods();
    g_vfs = *g_real;
    g_vfs.szOsFile = static_cast<int>(sizeof(File)) + g_real->szOsFile;
    g_vfs.zName = "weave-faults";
    g_vfs.xOpen = open_file;
    g_vfs.xDelete = delete_file;
    sqlite3_vfs_register(&g_vfs, 1);
    if (forget_full) sqlite3_auto_extension(normal_extension());
}

FaultDisk::~FaultDisk() {
    if (m_forget_full) sqlite3_cancel_auto_extension(normal_extension());
    sqlite3_vfs_unregister(&g_vfs);
    sqlite3_vfs_register(g_real, 1);
    g_disk = nullptr;
}

void FaultDisk::plan(DiskFault fault, std::uint64_t at, std::uint64_t seed) {
    const std::lock_guard lock(m_mutex);
    m_fault = fault;
    m_at = at;
    m_calls = 0;
    m_happened = false;
    m_random.seed(seed);
}

bool FaultDisk::happened() const {
    const std::lock_guard lock(m_mutex);
    return m_happened;
}

void FaultDisk::cut_power() {
    const std::lock_guard lock(m_mutex);
    if (!m_dark) lose_power();
}

/// What the call that comes now meets. Called under the lock.
DiskFault FaultDisk::next_call() {
    if (m_dark) return DiskFault::power_loss;
    if (m_fault == DiskFault::none || ++m_calls != m_at) return DiskFault::none;
    m_happened = true;
    if (m_fault == DiskFault::power_loss) lose_power();
    return m_fault;
}

std::string FaultDisk::content_of(sqlite3_file* real) {
    sqlite3_int64 size = 0;
    real->pMethods->xFileSize(real, &size);
    std::string bytes(static_cast<std::size_t>(size), '\0');
    if (size > 0) real->pMethods->xRead(real, bytes.data(), static_cast<int>(size), 0);
    return bytes;
}

void FaultDisk::lose_power() {
    m_dark = true;
    for (auto& [path, image] : m_images) {
        const auto open = m_open.find(path);
        const std::string now =
            open == m_open.end() || open->second.empty() ? image.flushed : content_of(*open->second.begin());
        const auto coin = [&] { return (m_random() & 1) == 1; };
        image.after_loss = image.flushed;
        if (now.size() != image.flushed.size() && coin()) image.after_loss.resize(now.size());
        for (const std::int64_t number : image.dirty) {
            const auto from = static_cast<std::size_t>(number * sector);
            if (from >= now.size() || from >= image.after_loss.size() || !coin()) continue;
            const std::size_t count = std::min(
                {static_cast<std::size_t>(sector), now.size() - from, image.after_loss.size() - from});
            std::memcpy(image.after_loss.data() + from, now.data() + from, count);
        }
    }
}

void FaultDisk::restore_power() {
    const std::lock_guard lock(m_mutex);
    for (auto& [path, image] : m_images) {
        std::ofstream(path, std::ios::binary | std::ios::trunc) << image.after_loss;
        if (image.after_loss.empty()) std::filesystem::remove(path);
        std::filesystem::remove(path.substr(0, path.rfind("-wal")) +
                                "-shm");  // memory is empty after a power loss
    }
    m_images.clear();
    m_dark = false;
    m_fault = DiskFault::none;
}

void FaultDisk::opened(const std::string& path, sqlite3_file* real) {
    const std::lock_guard lock(m_mutex);
    m_open[path].insert(real);
    if (!m_dark && !m_images.contains(path)) m_images[path].flushed = content_of(real);
}

void FaultDisk::closed(const std::string& path, sqlite3_file* real) {
    const std::lock_guard lock(m_mutex);
    m_open[path].erase(real);
}

int FaultDisk::write(File& file, const void* data, int count, sqlite3_int64 offset) {
    const std::lock_guard lock(m_mutex);
    sqlite3_file* real = file.real();
    const DiskFault fault = file.path == nullptr ? DiskFault::none : next_call();
    if (fault == DiskFault::full) return SQLITE_FULL;
    if (fault == DiskFault::io_error || fault == DiskFault::power_loss) return SQLITE_IOERR_WRITE;
    const int written = fault == DiskFault::short_write ? count / 2 : count;
    const int code = real->pMethods->xWrite(real, data, written, offset);
    if (file.path != nullptr)
        for (std::int64_t number = offset / sector; number * sector < offset + written; ++number)
            m_images[*file.path].dirty.insert(number);
    return fault == DiskFault::short_write ? SQLITE_IOERR_WRITE : code;
}

int FaultDisk::truncate(File& file, sqlite3_int64 size) {
    const std::lock_guard lock(m_mutex);
    if (file.path != nullptr && next_call() != DiskFault::none) return SQLITE_IOERR_TRUNCATE;
    return file.real()->pMethods->xTruncate(file.real(), size);
}

int FaultDisk::sync(File& file, int flags) {
    const std::lock_guard lock(m_mutex);
    if (file.path == nullptr) return SQLITE_OK;
    if (next_call() != DiskFault::none) return SQLITE_IOERR_FSYNC;
    static_cast<void>(flags);  // the real disk need not be flushed: the image is what counts here
    Image& image = m_images[*file.path];
    image.flushed = content_of(file.real());
    image.dirty.clear();
    return SQLITE_OK;
}

int FaultDisk::remove(const std::string& path, int flags, sqlite3_vfs* real) {
    const std::lock_guard lock(m_mutex);
    if (m_dark) return SQLITE_IOERR_DELETE;
    m_images.erase(path);
    return real->xDelete(real, path.c_str(), flags);
}

}  // namespace weave::testing
