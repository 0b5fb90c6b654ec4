// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/module/test_cache.hpp"

#include <cstdlib>

namespace vkpt::tests {

namespace fs = std::filesystem;

namespace {

const fs::path shared_cache = fs::path(VKPT_TEST_CACHE) / "shared";

// File by file: other tests use the folder at the same time, and what vanishes meanwhile is done without.
void copy_files(const fs::path& from, const fs::path& to)
{
    std::error_code ignored;
    for (auto entry = fs::recursive_directory_iterator(from, ignored); entry != fs::recursive_directory_iterator();
         entry.increment(ignored)) {
        const fs::path target = to / entry->path().lexically_relative(from);
        if (entry->is_directory(ignored))
            fs::create_directories(target, ignored);
        else
            fs::copy_file(entry->path(), target, ignored);
    }
}

} // namespace

OwnCache::OwnCache(const std::string& name)
    : path_(fs::path(VKPT_TEST_CACHE) / name)
{
    if (!fs::exists(path_)) {
        fs::create_directories(path_);
        copy_files(shared_cache, path_);
    }
    setenv("VKPT_CACHE_DIR", path_.c_str(), 1);
}

OwnCache::~OwnCache() { unsetenv("VKPT_CACHE_DIR"); }

void use_shared_cache() { setenv("VKPT_CACHE_DIR", shared_cache.c_str(), 0); }

} // namespace vkpt::tests
