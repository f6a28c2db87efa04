#pragma once

#include <dolp/errors.hpp>
#include <string>

namespace dolp {

/// The message of the exception that a call throws. `Error` is the type of the exception.
template <class Error = InputError, class Call>
std::string error_text(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace dolp
