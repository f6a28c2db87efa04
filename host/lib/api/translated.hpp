// Errors of the rooms as those of the public header.
#pragma once

#include <dolp/dolp.hpp>

#include "base/error.hpp"
#include "base/progress.hpp"

namespace dolp::api {

/// What `body` returns; what it throws becomes the public class.
template <class Body>
auto translated(const Body& body) {
  try {
    return body();
  } catch (const dolp::InputError& error) {
    throw InputError(error.what());
  } catch (const dolp::DeviceError& error) {
    throw DeviceError(error.what());
  } catch (const dolp::MemoryError& error) {
    throw MemoryError(error.what());
  } catch (const dolp::IoError& error) {
    throw IoError(error.what());
  } catch (const dolp::Cancelled& cancelled) {
    throw Cancelled(cancelled.left.empty() ? "no file was written" : cancelled.left);
  }
}

}  // namespace dolp::api
