// The threads on which OpenEXR decodes.
#include "src/io/exr/exr_threads.hpp"

#include <OpenEXR/IlmThreadPool.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <limits>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace spectile::io {
namespace {

/// OpenEXR's own pool waits for ever, at exit, for a thread that could not be made.
class Pool : public IlmThread::ThreadPoolProvider {
 public:
  explicit Pool(int threads) { start(threads); }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  ~Pool() override { stop(); }

  int numThreads() const override {
    const std::scoped_lock lock(mutex_);
    return static_cast<int>(threads_.size());
  }

  void setNumThreads(int count) override {
    stop();
    start(count);
  }

  void addTask(IlmThread::Task* task) override {
    {
      const std::scoped_lock lock(mutex_);
      if (!threads_.empty() && queued(task)) {
        added_.notify_one();
        return;
      }
    }
    if (IlmThread::TaskGroup* const group = execute(task)) group->finishOneTask();
  }

  void finish() override { stop(); }

 private:
  void start(int count) {
    const std::scoped_lock lock(mutex_);
    stopping_ = false;
    try {
      threads_.reserve(static_cast<std::size_t>(count));
      while (static_cast<int>(threads_.size()) < count) threads_.emplace_back([this] { run(); });
    } catch (const std::system_error&) {  // those that there are will do
    } catch (const std::bad_alloc&) {
    }
  }

  bool queued(IlmThread::Task* task) {
    try {
      tasks_.push_back(task);
      return true;
    } catch (const std::bad_alloc&) {
      return false;
    }
  }

  /// Returns the group that the task belonged to, or null.
  static IlmThread::TaskGroup* execute(IlmThread::Task* task) {
    IlmThread::TaskGroup* const group = task->group();
    task->execute();
    delete task;
    return group;
  }

  void run() {
    std::unique_lock lock(mutex_);
    for (;;) {
      added_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      IlmThread::Task* const task = tasks_.front();
      tasks_.pop_front();
      lock.unlock();
      IlmThread::TaskGroup* const group = execute(task);
      lock.lock();
      // With the lock, so that ThreadSanitizer, which does not see the group's own counter, knows that all of
      // its tasks come before its end.
      if (group != nullptr) group->finishOneTask();
    }
  }

  /// Ends the threads when all tasks are done.
  void stop() {
    std::vector<std::thread> ending;
    {
      const std::scoped_lock lock(mutex_);
      stopping_ = true;
      ending.swap(threads_);
    }
    added_.notify_all();
    for (std::thread& thread : ending) thread.join();
  }

  mutable std::mutex mutex_;
  std::condition_variable added_;
  std::deque<IlmThread::Task*> tasks_;
  std::vector<std::thread> threads_;
  bool stopping_ = false;
};

}  // namespace

void set_exr_threads(int threads) {
  static std::mutex mutex;
  static int most = std::numeric_limits<int>::max();  // that the system makes
  const std::scoped_lock lock(mutex);
  threads = std::min(threads, most);
  IlmThread::ThreadPool& pool = IlmThread::ThreadPool::globalThreadPool();
  if (pool.numThreads() == threads) return;
  // OpenEXR deletes it. A pool of none, since OpenEXR 3.1 looks for threads in one that is not there.
  pool.setThreadProvider(new Pool(threads));
  if (pool.numThreads() < threads) most = pool.numThreads();
}

}  // namespace spectile::io
