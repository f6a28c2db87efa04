// Lets a C++ allocation fail, in programs that link failing_new.cpp.
#pragma once

namespace dolp {

/// While the object exists, the first `before` allocations of this thread succeed, and the next throws std::bad_alloc.
class FailingNew {
 public:
  explicit FailingNew(long before);
  ~FailingNew();
  FailingNew(const FailingNew&) = delete;
  FailingNew& operator=(const FailingNew&) = delete;

  bool has_failed() const;
};

}  // namespace dolp
