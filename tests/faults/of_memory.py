"""Faults of memory and threads. The function of a fault yields the exit status of each try."""
import concurrent.futures
import csv
import operator
import os
import re
import resource

from attempt import CPU, DONE, LARGE, LIBRARY, MEMORY


def agree(ours, theirs):
    """True if two results of `eval` differ by at most the sum of their error bounds, as results of two kernels may."""
    rows, others = (list(csv.DictReader(text.decode().splitlines())) for text in (ours, theirs))
    if len(rows) != len(others):
        return False
    for row, other in zip(rows, others):
        for name, bound, scale in (("dolp", "error_estimate", 1), ("rho_i", "rho_error_estimate", float(row["rho_i"]))):
            if not abs(float(row[name]) - float(other[name])) <= scale * (float(row[bound]) + float(other[bound])):
                return False
    return [row["status"] for row in rows] == [row["status"] for row in others]


def allocations_of(driver, command, options, quick, step, is_same=operator.eq):
    """Makes two tries for each multiple n of `step`. In one only the n-th allocation fails, in the other all from n."""
    driver.expect(command, options)
    count = driver.count("allocation", "DOLP_COUNT_ALLOCATIONS", command, options)

    def fail(number):
        environment = driver.preload("allocation", DOLP_FAIL_ALLOCATION=number)
        return driver.try_once(command, options, (DONE, MEMORY, *LIBRARY), environment=environment, is_same=is_same)

    # With several threads the number of allocations differs between runs. So a run may end before the n-th allocation.
    numbers = [f"{n}{after}" for n in driver.numbers(count // step, quick // 2) for after in ("", "+")]
    numbers = [re.sub(r"\d+", lambda n: str(int(n.group()) * step), number) for number in numbers]
    with concurrent.futures.ThreadPoolExecutor(1 if driver.is_quick else os.cpu_count()) as pool:
        yield from pool.map(fail, numbers)


def allocation_in_table(driver):
    """the n-th allocation of `table` fails, alone or with all after it"""
    return allocations_of(driver, "table", CPU, 100, 1)


def allocation_in_eval(driver):
    """the n-th allocation of `eval` fails, alone or with all after it"""
    return allocations_of(driver, "eval", CPU, 100, 1)


def allocation_in_lookup(driver):
    """the n-th allocation of `lookup` fails, alone or with all after it"""
    return allocations_of(driver, "lookup", (), 100, 1)


def allocation_with_driver(driver):
    """every 100th allocation of `eval` on a Vulkan device fails, in its driver too"""
    # The 100th allocation fails in one try, the 200th in another try, and so on. Allocations of the driver count, too.
    # If the driver's compiler lacks memory, it may make a slightly different kernel without an error message. So
    # agree() compares the results.
    return allocations_of(driver, "eval", (), 10, 100, agree)


def memory_limit(driver):
    """the addresses of `table` on a Vulkan device are limited (RLIMIT_AS), 100 MB to 2 GB"""
    driver.expect("table", LARGE)
    for megabytes in ((100, 150, 300, 500, 1000) if driver.is_quick else range(100, 2001, 20)):
        limit = (resource.RLIMIT_AS, megabytes * 1_000_000)
        yield driver.try_once("table", LARGE, (DONE, MEMORY, *LIBRARY), limit=limit)


def few_threads(driver):
    """the system allows n threads beside the first"""
    driver.expect("table", LARGE)
    # Number of threads that the program and the driver lavapipe need. With fewer threads lavapipe cannot work.
    needed = 2 * min(os.cpu_count(), 32) + 3
    for n in [0, *driver.numbers(needed, 7)] if driver.is_quick else range(needed + 20):
        fault = driver.preload("thread", DOLP_MOST_THREADS=str(n))
        yield driver.try_once("table", LARGE, (MEMORY,) if n < needed else (DONE, MEMORY), environment=fault)


KINDS = (allocation_in_table, allocation_in_eval, allocation_in_lookup, allocation_with_driver, memory_limit, few_threads)
