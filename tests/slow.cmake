# Read by ctest for the tests that it discovers: those labelled nightly run in .ci/nightly and in tests/run
# alone, and begin first, so that no processor waits for one of them at the end.
foreach(test
        driver.elastic_share.leads_to_an_equilibrium_where_the_residual_rises
        driver.line_search.never_increases_the_residual
        unit.packed_spheres.five_hundred_reach_it_too_grown_or_scattered
        faults.evaluation_without_memory.is_told_and_the_next_one_has_the_same_answer)
  set_tests_properties(${test} PROPERTIES LABELS nightly COST 100)
endforeach()
# Half a minute and more each under the address sanitizer, where they run in .ci/nightly.
foreach(test
        servo.without_inheritance_stays_off_by_the_friction_of_starting_over
        servo.meets_the_direct_relaxation_in_proportion_to_the_increment
        compaction.refuses_what_cannot_be
        loose_tolerance.ends_where_a_packing_does_not_settle_and_changes_nothing_elsewhere
        law_state.energy_balances_over_a_cycle_to_first_order_of_the_increment
        law_state.energy_balances_with_drag_to_first_order_of_the_increment
        law_tangent.through_sub_increments_matches_central_differences
        sphere_drag.tangent_matches_central_differences
        drag.tangent_matches_central_differences)
  set_tests_properties(unit.${test} PROPERTIES LABELS slow_under_asan COST 60)
endforeach()
