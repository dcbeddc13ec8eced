"""Other hosts than fmpy: libcosim from Python and from a C program, and a C program that loads the library itself."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from hosts import Host
from standin import compile_c, sanitizers

STEP, STEPS = 0.05, 38
NAMES = ("tip.x", "tip.y", "push.force", "wall.force.max")


@pytest.fixture(scope="module")
def expected(fmus):
    with Host(fmus[2]).start() as host:
        for _ in range(STEPS):
            host.step(STEP)
        assert host.get("wall.force.max") > 0
        return {name: host.get(name) for name in NAMES}, {n: host.variables[n].valueReference for n in NAMES}


def test_libcosim_gives_the_same_numbers_with_two_instances(fmus, expected):
    pytest.importorskip("libcosimpy", reason="libcosimpy is not installed")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    values, references = expected
    with Host(fmus[2]) as host:
        friction = host.variables["contact.friction_coefficient"].valueReference
    execution = CosimExecution.from_step_size(int(STEP * 1e9))
    slaves = [
        execution.add_local_slave(CosimLocalSlave(fmu_path=str(fmus[2]), instance_name=name)) for name in ("a", "b")
    ]
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    assert execution.real_initial_value(slaves[1], friction, 0.1)
    assert execution.step(STEPS)
    wanted = [references[name] for name in NAMES]
    first, second = (observer.last_real_values(slave_index=slave, variable_references=wanted) for slave in slaves)
    assert list(first) == pytest.approx(list(values.values()), rel=1e-9)
    assert list(first) != list(second)


COSIM = r"""
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
typedef struct cosim_execution cosim_execution;
typedef struct cosim_slave cosim_slave;
typedef struct cosim_observer cosim_observer;
cosim_execution *cosim_execution_create(int64_t start, int64_t step);
cosim_slave *cosim_local_slave_create(const char *fmu, const char *name);
int cosim_execution_add_slave(cosim_execution *, cosim_slave *);
cosim_observer *cosim_last_value_observer_create(void);
int cosim_execution_add_observer(cosim_execution *, cosim_observer *);
int cosim_execution_step(cosim_execution *, size_t);
int cosim_observer_slave_get_real(cosim_observer *, int, const uint32_t[], size_t, double[]);
int cosim_execution_destroy(cosim_execution *);
int main(int argc, char **argv) {
    double value[16];
    uint32_t references[16];
    size_t count = (size_t)argc - 4;
    cosim_execution *execution = cosim_execution_create(0, atoll(argv[2]));
    int slave = cosim_execution_add_slave(execution, cosim_local_slave_create(argv[1], "c"));
    cosim_observer *observer = cosim_last_value_observer_create();
    cosim_execution_add_observer(execution, observer);
    for (size_t i = 0; i < count; i++) references[i] = (uint32_t)atoi(argv[4 + i]);
    if (slave < 0 || cosim_execution_step(execution, (size_t)atoi(argv[3])) != 0) return 1;
    if (cosim_observer_slave_get_real(observer, slave, references, count, value) != 0) return 2;
    for (size_t i = 0; i < count; i++) printf("%.17g\n", value[i]);
    cosim_execution_destroy(execution);
    return 0;
}
"""


def build(source: str, folder: Path, *options: str) -> Path:
    (folder / "host.c").write_text(source)
    return compile_c(folder / "host.c", folder / "host", "-Werror", *sanitizers(), *options)


def test_a_c_program_with_libcosim_gives_the_same_numbers(fmus, expected, tmp_path):
    found = find_spec("libcosimpy")
    if found is None or not sys.platform.startswith("linux"):
        pytest.skip("libcosimpy for Linux, which brings libcosimc.so, is not installed")
    library = Path(found.origin).parent / "libcosimc" / "libcosimc.so"
    values, references = expected
    host = build(COSIM, tmp_path, str(library), f"-Wl,-rpath,{library.parent}")
    wanted = [str(references[name]) for name in NAMES]
    run = subprocess.run(
        [host, fmus[2], str(int(STEP * 1e9)), str(STEPS), *wanted], capture_output=True, text=True, timeout=120
    )
    assert run.returncode == 0, run.stderr[-2000:]
    numbers = [float(line) for line in run.stdout.splitlines()[-len(wanted) :]]
    assert numbers == pytest.approx(list(values.values()), rel=1e-9)


BARE = r"""
#include "fmi3FunctionTypes.h"
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
static void say(fmi3InstanceEnvironment e, fmi3Status s, fmi3String c, fmi3String m) {
    (void)e, (void)s;
    fprintf(stderr, "%s: %s\n", c, m);
}
#define GET(TYPE, NAME) TYPE *NAME = (TYPE *)dlsym(library, #NAME); if (NAME == NULL) return 3
int main(int argc, char **argv) {
    void *library = dlopen(argv[1], RTLD_NOW);
    fmi3Boolean event, terminate, early;
    double last, value;
    if (argc < 5 || library == NULL) return 2;
    GET(fmi3InstantiateCoSimulationTYPE, fmi3InstantiateCoSimulation);
    GET(fmi3EnterInitializationModeTYPE, fmi3EnterInitializationMode);
    GET(fmi3ExitInitializationModeTYPE, fmi3ExitInitializationMode);
    GET(fmi3DoStepTYPE, fmi3DoStep);
    GET(fmi3GetFloat64TYPE, fmi3GetFloat64);
    GET(fmi3FreeInstanceTYPE, fmi3FreeInstance);
    fmi3Instance fmu = fmi3InstantiateCoSimulation("c", argv[3], argv[2], false, false, false, false, NULL, 0, NULL,
                                                   say, NULL);
    if (fmu == NULL) return 4;
    if (fmi3EnterInitializationMode(fmu, false, 0, 0, false, 0) || fmi3ExitInitializationMode(fmu)) return 5;
    for (int i = 0; i < STEPS; i++)
        if (fmi3DoStep(fmu, i * 0.05, 0.05, true, &event, &terminate, &early, &last)) return 6;
    for (int i = 4; i < argc; i++) {
        fmi3ValueReference reference = (fmi3ValueReference)atoi(argv[i]);
        if (fmi3GetFloat64(fmu, &reference, 1, &value, 1)) return 7;
        printf("%.17g\n", value);
    }
    fmi3FreeInstance(fmu);
    dlclose(library);
    return 0;
}
"""


def test_a_c_program_that_loads_the_library_itself_under_an_empty_environment(fmus, expected, tmp_path):
    from gw_exudyn.fmi.wrapper.build import fmi_headers

    values, _ = expected
    host = build(BARE, tmp_path, f"-I{fmi_headers()}", f"-DSTEPS={STEPS}", "-ldl")
    with Host(fmus[3]) as unpacked:
        library = unpacked.folder / "binaries" / "x86_64-linux" / "arc90.so"
        if os.uname().machine != "x86_64":
            pytest.skip("this machine is not x86_64")
        references = [str(unpacked.variables[name].valueReference) for name in NAMES]
        token, resources = unpacked.description.guid, f"{unpacked.folder}/resources/"
        run = subprocess.run(
            [host, library, resources, token, *references], capture_output=True, text=True, timeout=120, env={}
        )
    assert run.returncode == 0, run.stderr[-2000:]
    assert [float(line) for line in run.stdout.split()] == pytest.approx(list(values.values()), rel=1e-9)
