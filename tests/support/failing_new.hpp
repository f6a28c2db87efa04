// Makes an allocation of C++ fail, in programs that link failing_new.cpp.
#pragma once

namespace dolp {

/// While the object exists, one allocation of its thread throws std::bad_alloc: the one after `before` others.
class FailingNew {
 public:
  explicit FailingNew(long before);
  ~FailingNew();
  FailingNew(const FailingNew&) = delete;
  FailingNew& operator=(const FailingNew&) = delete;

  bool has_failed() const;
};

}  // namespace dolp
