#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace wale {

/// Runs work(task, add) for every task of `open` and every one that is added on the way by add(task), on `threads`
/// threads (0 or 1: the caller's alone), in no certain order. Throws the first exception of any of them.
template <typename Task, typename Work>
void run_tasks(unsigned threads, std::vector<Task> open, const Work& work) {
  std::mutex mutex;
  std::condition_variable changed;
  std::exception_ptr failure;
  unsigned busy = 0;
  const auto add = [&](Task task) {
    const std::lock_guard lock(mutex);
    open.push_back(std::move(task));
    changed.notify_one();
  };
  const auto serve = [&] {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return !open.empty() || busy == 0; });
      if (open.empty() || failure) break;
      Task task = std::move(open.back());
      open.pop_back();
      ++busy;
      lock.unlock();
      std::exception_ptr thrown;
      try {
        work(task, add);
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      --busy;
      if (thrown && !failure) failure = thrown;
      if (open.empty() || failure) changed.notify_all();
    }
    changed.notify_all();
  };
  std::vector<std::jthread> others;
  for (unsigned i = 1; i < threads; ++i) others.emplace_back(serve);
  serve();
  others.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace wale
