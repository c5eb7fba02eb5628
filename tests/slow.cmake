# Read by ctest for the tests that it discovers: those labelled nightly run in .ci/nightly and in tests/run
# alone, and begin first, so that no processor waits for one of them at the end.
foreach(test
        driver.elastic_share.leads_to_an_equilibrium_where_the_residual_rises
        driver.line_search.never_increases_the_residual
        unit.packed_spheres.five_hundred_reach_it_too_grown_or_scattered
        faults.evaluation_without_memory.is_told_and_the_next_one_has_the_same_answer)
  set_tests_properties(${test} PROPERTIES LABELS nightly COST 100)
endforeach()
