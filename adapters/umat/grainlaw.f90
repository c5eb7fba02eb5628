! The C interface for Fortran hosts, as include/grainlaw has it: names without their prefix, arrays
! row by row. Texts end with c_null_char; c_loc and c_null_ptr give arguments that may be null.
module grainlaw
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: want_tangent_exact = 1, want_tangent_elastic = 2, &
    want_tangent_perturbed = 4

  type, bind(c) :: grainlaw_report
    integer(c_size_t) :: size
    real(c_double) :: residual, step_ratio
    integer(c_long) :: relaxation_steps, servo_corrections
    integer(c_int) :: factorisations, subincrements, contacts, sliding, status_changes, &
      tangent_exact, history_advanced
    character(kind=c_char) :: message(256)
    integer(c_int) :: broken_bonds
    real(c_double) :: unbalanced, viscous_work
    integer(c_int) :: rattlers_loaded
  end type

  type, bind(c) :: grainlaw_summary
    integer(c_size_t) :: size
    real(c_double) :: step_ratio
    integer(c_long) :: failed, first_failed
    character(kind=c_char) :: message(256)
    integer(c_int) :: rank
  end type

  interface
    integer(c_int) function material_load(path, out, message, message_size) &
        bind(c, name="grainlaw_material_load")
      import
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), intent(out) :: out
      character(kind=c_char), intent(out) :: message(*)
      integer(c_size_t), value :: message_size
    end function
    integer(c_int) function material_dimension(material) bind(c, name="grainlaw_material_dimension")
      import
      type(c_ptr), value :: material
    end function
    subroutine material_destroy(material) bind(c, name="grainlaw_material_destroy")
      import
      type(c_ptr), value :: material
    end subroutine

    type(grainlaw_report) function report_default() bind(c, name="grainlaw_report_default")
      import
    end function
    type(grainlaw_summary) function summary_default() bind(c, name="grainlaw_summary_default")
      import
    end function

    integer(c_int) function state_create(material, out) bind(c, name="grainlaw_state_create")
      import
      type(c_ptr), value :: material
      type(c_ptr), intent(out) :: out
    end function
    subroutine state_destroy(state) bind(c, name="grainlaw_state_destroy")
      import
      type(c_ptr), value :: state
    end subroutine
    integer(c_int) function evaluate(state, F, want, P, A, report) bind(c, name="grainlaw_evaluate")
      import
      type(c_ptr), value :: state
      real(c_double), intent(in) :: F(*)
      integer(c_int), value :: want
      real(c_double), intent(inout) :: P(*), A(*)
      type(grainlaw_report), intent(inout) :: report
    end function
    integer(c_int) function set_time_step(state, step) bind(c, name="grainlaw_state_set_time_step")
      import
      type(c_ptr), value :: state
      real(c_double), value :: step
    end function
    integer(c_int) function commit(state) bind(c, name="grainlaw_commit")
      import
      type(c_ptr), value :: state
    end function
    integer(c_int) function revert(state) bind(c, name="grainlaw_revert")
      import
      type(c_ptr), value :: state
    end function

    integer(c_int) function points_create(material, n, out) bind(c, name="grainlaw_points_create")
      import
      type(c_ptr), value :: material
      integer(c_size_t), value :: n
      type(c_ptr), intent(out) :: out
    end function
    subroutine points_destroy(points) bind(c, name="grainlaw_points_destroy")
      import
      type(c_ptr), value :: points
    end subroutine
    ! status and reports may be c_null_ptr.
    integer(c_int) function points_evaluate(points, F, want, P, A, status, reports, threads, summary) &
        bind(c, name="grainlaw_points_evaluate")
      import
      type(c_ptr), value :: points, status, reports
      real(c_double), intent(in) :: F(*)
      integer(c_int), value :: want, threads
      real(c_double), intent(inout) :: P(*), A(*)
      type(grainlaw_summary), intent(inout) :: summary
    end function
    integer(c_int) function points_answer(points, want, P, A, threads, summary) &
        bind(c, name="grainlaw_points_answer")
      import
      type(c_ptr), value :: points
      integer(c_int), value :: want, threads
      real(c_double), intent(inout) :: P(*), A(*)
      type(grainlaw_summary), intent(inout) :: summary
    end function
    integer(c_int) function points_set_time_step(points, step) &
        bind(c, name="grainlaw_points_set_time_step")
      import
      type(c_ptr), value :: points
      real(c_double), value :: step
    end function
    integer(c_int) function points_commit(points) bind(c, name="grainlaw_points_commit")
      import
      type(c_ptr), value :: points
    end function
    integer(c_int) function points_revert(points) bind(c, name="grainlaw_points_revert")
      import
      type(c_ptr), value :: points
    end function
    ! bytes may be c_null_ptr: asks for the size.
    integer(c_int) function points_save(points, bytes, size) bind(c, name="grainlaw_points_save")
      import
      type(c_ptr), value :: points, bytes
      integer(c_size_t), intent(inout) :: size
    end function
    integer(c_int) function points_load(points, bytes, size, message, message_size) &
        bind(c, name="grainlaw_points_load")
      import
      type(c_ptr), value :: points, bytes
      integer(c_size_t), value :: size, message_size
      character(kind=c_char), intent(out) :: message(*)
    end function

    integer(c_int) function table_create(material, out) bind(c, name="grainlaw_table_create")
      import
      type(c_ptr), value :: material
      type(c_ptr), intent(out) :: out
    end function
    subroutine table_destroy(table) bind(c, name="grainlaw_table_destroy")
      import
      type(c_ptr), value :: table
    end subroutine
    integer(c_int) function table_evaluate(table, element, point, token, F0, F, time_step, want, P, A, &
        report) bind(c, name="grainlaw_table_evaluate")
      import
      type(c_ptr), value :: table, F0
      integer(c_long_long), value :: element, point
      real(c_double), intent(inout) :: token
      real(c_double), intent(in) :: F(*)
      real(c_double), value :: time_step
      integer(c_int), value :: want
      real(c_double), intent(inout) :: P(*), A(*)
      type(grainlaw_report), intent(inout) :: report
    end function
  end interface
contains
  ! A message of the library as Fortran text.
  function text_of(characters) result(text)
    character(kind=c_char), intent(in) :: characters(:)
    character(len=:), allocatable :: text
    integer :: k
    text = ""
    do k = 1, size(characters)
      if (characters(k) == c_null_char) exit
      text = text//characters(k)
    end do
  end function
end module
