"""Faults of Vulkan devices and their drivers. The function of a fault yields the exit status of each try."""
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import time

from attempt import DEVICE, DONE, FOLDERS, INTERRUPTED, LARGE, MEMORY, TIMEOUT_S, Broken

VULKAN_CALLS = ("vkCreateInstance", "vkEnumeratePhysicalDevices", "vkCreateDevice", "vkCreateCommandPool",
                "vkAllocateCommandBuffers", "vkCreateBuffer", "vkAllocateMemory", "vkBindBufferMemory", "vkMapMemory",
                "vkCreateDescriptorSetLayout", "vkAllocateDescriptorSets", "vkCreateShaderModule",
                "vkCreateComputePipelines", "vkBeginCommandBuffer", "vkEndCommandBuffer", "vkQueueSubmit",
                "vkWaitForFences")
VULKAN_RESULTS = {"out of host memory": -1, "out of device memory": -2, "initialisation failed": -3, "device lost": -4}
DEVICE_LOST = VULKAN_RESULTS["device lost"]


def lost_device(driver):
    """the device is lost at the n-th submission: a new one takes over"""
    driver.expect("eval", LARGE)
    driver.expect("table", LARGE)
    for command in ("eval", "table"):
        count = driver.count("vulkan", "DOLP_COUNT_SUBMISSIONS", command, LARGE)
        for call in ("vkQueueSubmit", "vkWaitForFences"):
            for n in driver.numbers(count, 3):
                fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"{call}:{n}:{DEVICE_LOST}")
                yield driver.try_once(command, LARGE, (DONE,), environment=fault)


def lost_devices(driver):
    """the device is lost at the n-th submission, and the new ones too"""
    driver.expect("table", LARGE)
    for n in range(1, 4):  # each run has that many submissions; how many more depends on the time that they take
        fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"vkQueueSubmit:{n}+:{DEVICE_LOST}")
        yield driver.try_once("table", LARGE, (DEVICE,), environment=fault)


def large_dispatch(driver):
    """the device is lost at dispatches of more than 32 workgroups or 1: tiles shrink, the values stay"""
    # In double, because the dispatch that measures the errors of float always has more workgroups.
    options = ("--precision", "double", "--set", "grid.theta_deg={from=0, to=89, count=30}")
    driver.expect("table", options)
    for workgroups, allowed in ((32, DONE), (1, DEVICE)):
        fault = driver.preload("vulkan", DOLP_VULKAN_DISPATCH=str(workgroups))
        yield driver.try_once("table", options, (allowed,), environment=fault)


def device_memory(driver):
    """the device refuses pieces of memory above a size: tiles shrink, the values stay"""
    driver.expect("table", LARGE)
    for kilobytes in ((1, 200, 1000) if driver.is_quick else (1, 10, 50, 100, 120, 150, 200, 300, 500, 1000, 5000)):
        fault = driver.preload("vulkan", DOLP_VULKAN_MEMORY=str(kilobytes * 1000))
        allowed = (MEMORY,) if kilobytes <= 1 else (DONE,) if kilobytes >= 200 else (DONE, MEMORY)
        yield driver.try_once("table", LARGE, allowed, environment=fault)


def vulkan_call(driver):
    """a call of Vulkan fails the first time, or each time"""
    driver.expect("eval")
    calls = [(call, result, after) for call in VULKAN_CALLS for result in VULKAN_RESULTS.values() for after in ("", "+")]
    for call, result, after in driver.random.sample(calls, 20) if driver.is_quick else calls:
        fault = driver.preload("vulkan", DOLP_FAIL_VULKAN=f"{call}:1{after}:{result}")
        yield driver.try_once("eval", (), (DONE, DEVICE, MEMORY), environment=fault)


def lacking_driver(driver):
    """the only device lacks double precision, a compute queue or Vulkan 1.2"""
    driver.expect("eval")
    double = ("--precision", "double")
    driver.expect("eval", double)
    for what, options, allowed in (("float64", (), DONE), ("float64", double, DEVICE), ("compute", (), DEVICE),
                                   ("version", (), DEVICE)):
        fault = driver.preload("vulkan", DOLP_VULKAN_WITHOUT=what)
        yield driver.try_once("eval", options, (allowed,), environment=fault)


def few_texels(driver):
    """the device allows 65,536 texels in a buffer, as many as Vulkan guarantees: the values stay"""
    films = ("--tolerance", "1e-6", "--set", "surface.coating=[{n=1.5, k=0.01, thickness_um=20}]",
             "--set", "spectrum.band_um=[8, 14]", "--set", "grid.theta_deg=[60]", "--set", "grid.sigma=[0.1]")
    shapes = ("--precision", "double", "--set", "grid.theta_deg=[60]",
              "--set", "grid.sigma=[0.01, 0.03, 0.1, 0.3, 1, 3]", "--set", "grid.q=[1.2, 1.6, 2, 4]")
    for options in (films, shapes):
        driver.expect("table", options)
        fault = driver.preload("vulkan", DOLP_VULKAN_TEXELS="65536")
        yield driver.try_once("table", options, (DONE,), environment=fault)


def broken_driver_file(driver):
    """the JSON file of a Vulkan driver is missing, empty, cut short or not JSON"""
    driver.expect("eval")
    for text in (None, "", "{", '{"file_format_version": "1.0.0"}', "\0\xff", "[]"):
        with tempfile.TemporaryDirectory(dir=FOLDERS) as folder:
            path = pathlib.Path(folder) / "driver.json"
            if text is not None:
                path.write_text(text)
            fault = {"VK_DRIVER_FILES": str(path), "VK_ICD_FILENAMES": str(path)}
            yield driver.try_once("eval", (), (DEVICE,), environment=fault)


def endless_compilation(driver):
    """the driver never finishes compiling a kernel"""
    driver.expect("eval")
    fault = driver.preload("vulkan", DOLP_FAIL_VULKAN="vkCreateComputePipelines:1+:never", DOLP_COMPILATION_LIMIT_S="0.5")
    for command in ("eval", "table"):
        driver.expect(command)
        yield driver.try_once(command, (), (DEVICE,), environment=fault)
    patient = {**fault, "DOLP_COMPILATION_LIMIT_S": "1000"}
    with driver.attempt("table", environment=patient) as attempt, attempt.start() as process:
        time.sleep(1)  # the signal must arrive while the driver compiles
        process.terminate()
        err = process.communicate(timeout=TIMEOUT_S)[1].decode()
        attempt.check(process.returncode, err, (INTERRUPTED, -signal.SIGTERM))
        yield process.returncode
    environment = {**os.environ, "DOLP_VALIDATION": "0", **fault}
    devices = subprocess.run([driver.program, "devices", "--json"], env=environment, capture_output=True, timeout=TIMEOUT_S,
                             check=False)
    device = json.loads(devices.stdout)["devices"][0]
    if devices.returncode != DEVICE or device["usable"] or "did not finish compiling" not in device["why_not"]:
        raise Broken(f"devices ends with {devices.returncode} and calls {device} usable")
    yield devices.returncode


KINDS = (lost_device, lost_devices, large_dispatch, device_memory, few_texels, vulkan_call, lacking_driver, broken_driver_file,
         endless_compilation)
