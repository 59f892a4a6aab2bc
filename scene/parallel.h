#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace airlight::scene {

using Progress = std::function<void(double fraction)>;  ///< called from the calling thread only

/// Works on the parts of a whole on every core, and returns when all are done.
///
/// @param make_worker called once on each thread; returns the callable `void(int part)` that this thread
/// applies to its parts, with whatever scratch memory it keeps
/// @param progress told the fraction of parts done, on the calling thread only, which works too
/// The first exception of any thread ends the work and is rethrown.
template <class MakeWorker>
void parallel(int parts, const MakeWorker& make_worker, const Progress& progress = {}) {
  std::atomic<int> next_part{0};
  std::atomic<int> parts_done{0};
  std::exception_ptr error;
  std::mutex error_mutex;

  const auto work = [&](const Progress& report) {
    try {
      auto worker = make_worker();
      for (int part = next_part++; part < parts; part = next_part++) {
        worker(part);
        const int done = ++parts_done;
        if (report) report(static_cast<double>(done) / parts);
      }
    } catch (...) {
      next_part = parts;
      const std::scoped_lock lock(error_mutex);
      if (!error) error = std::current_exception();
    }
  };

  {
    std::vector<std::jthread> helpers;
    const int helper_count = std::min(static_cast<int>(std::thread::hardware_concurrency()), parts) - 1;
    helpers.reserve(static_cast<std::size_t>(std::max(helper_count, 0)));
    for (int i = 0; i < helper_count; ++i) helpers.emplace_back([&] { work({}); });
    work(progress);
  }
  if (error) std::rethrow_exception(error);
  if (progress) progress(1.0);
}

}  // namespace airlight::scene
