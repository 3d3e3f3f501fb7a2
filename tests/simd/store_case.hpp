#pragma once

#include <catch2/catch.hpp>

#include <filesystem>
#include <simd/store/store.hpp>
#include <support/temporary_folder.hpp>

namespace weave::simd::testing {

using Folder = weave::testing::TemporaryFolder;

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
