#include "bench/cpu_crowd/pool.h"

namespace skitter::cpu_crowd {

Pool::Pool(int threads) {
  for (int i = 1; i < threads; ++i) others_.emplace_back([this, i] { serve(i); });
}

Pool::~Pool() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  begin_.notify_all();
  for (std::thread& other : others_) other.join();
}

void Pool::run(size_t parts, const std::function<void(size_t, int)>& work) {
  {
    const std::lock_guard lock(mutex_);
    work_ = &work;
    parts_ = parts;
    next_ = 0;
    busy_ = others_.size();
    ++round_;
  }
  begin_.notify_all();
  takeParts(0);
  std::unique_lock lock(mutex_);
  end_.wait(lock, [this] { return busy_ == 0; });
}

void Pool::serve(int thread) {
  uint64_t seen = 0;
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      begin_.wait(lock, [&] { return over_ || round_ != seen; });
      if (over_) return;
      seen = round_;
    }
    takeParts(thread);
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) end_.notify_one();
  }
}

void Pool::takeParts(int thread) {
  for (size_t part = next_++; part < parts_; part = next_++) (*work_)(part, thread);
}

}  // namespace skitter::cpu_crowd
