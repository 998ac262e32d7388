#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace skitter::cpu_crowd {

// Threads that sleep between calls, the caller one of them.
class Pool {
 public:
  explicit Pool(int threads);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  // Calls work(part, thread) for each part once, and returns when all are done. Threads take parts as they
  // come.
  void run(size_t parts, const std::function<void(size_t part, int thread)>& work);

 private:
  void serve(int thread);
  void takeParts(int thread);

  const std::function<void(size_t, int)>* work_ = nullptr;
  size_t parts_ = 0;
  std::atomic<size_t> next_ = 0;
  std::mutex mutex_;
  std::condition_variable begin_, end_;
  uint64_t round_ = 0;
  size_t busy_ = 0;
  bool over_ = false;
  std::vector<std::thread> others_;
};

}  // namespace skitter::cpu_crowd
