#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <simd/store/store.hpp>
#include <unistd.h>

namespace weave::simd::testing {

/// A folder that goes away with the test.
class Folder {
  public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "weave-simd-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        m_path = name;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(m_path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return m_path / name; }

  private:
    std::filesystem::path m_path;
};

inline std::unique_ptr<Store> opened(const std::filesystem::path& path) {
    auto store = Store::open(path);
    INFO((store ? "" : store.error().text()));
    REQUIRE(store);
    return std::move(*store);
}

inline std::vector<KeptJob> jobs_in(Store& store, JobPhase phase) {
    std::vector<KeptJob> jobs = store.jobs().value();
    std::erase_if(jobs, [&](const KeptJob& job) { return job.phase != phase; });
    return jobs;
}

}  // namespace weave::simd::testing
