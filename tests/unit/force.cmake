# Tests of force.
tact_test(unit/force_docking_test.cpp USES force)
