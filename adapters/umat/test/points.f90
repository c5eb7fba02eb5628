! Single points: the patch and its tangent, a cut, a restart, bad input.
!   points patch MATERIAL.toml PATH.csv | tangent DIMENSION | cut | restart | bad_input
program points
  use grainlaw
  use material_point
  implicit none
  character(len=1024) :: mode, argument
  call get_command_argument(1, mode)
  select case (mode)
  case ("patch")
    call patch(4)
    call patch(6)
  case ("tangent")
    call get_command_argument(2, argument)
    if (argument == "2") then
      call tangent(4, [1, 2, 4])
      call tangent(6, [1, 2, 4])
    else
      call tangent(6, [1, 2, 3, 4, 5, 6])
    end if
  case ("cut")
    call cut
  case ("restart")
    call restart
  case ("bad_input")
    call bad_input
  case default
    stop 2
  end select
  print '(2a)', "passed: ", trim(mode)
contains
  ! Cauchy stress is that of P from the library itself, with a retry in each increment.
  subroutine patch(ntens)
    integer, intent(in) :: ntens
    type(c_ptr) :: material, state
    type(grainlaw_report) :: report
    character(kind=c_char) :: message(512)
    character(len=1024) :: path
    double precision :: F(4), P(4), A(16), f1(3, 3), full(3, 3), sigma(3, 3), stress(ntens), &
      c(ntens, ntens), pnewdt
    type(point_t) :: point
    integer :: unit, status, steps, k
    point%number = ntens
    call get_command_argument(2, path)
    call require(material_load(trim(path)//c_null_char, material, message, 512_c_size_t) == 0, &
      text_of(message))
    call require(state_create(material, state) == 0, "a state")
    call material_destroy(material)
    report = report_default()
    call require(report%size == c_sizeof(report), "the report has the size of the header's")
    call get_command_argument(3, path)
    open (newunit=unit, file=trim(path), action="read")
    read (unit, *)
    steps = 0
    do
      read (unit, *, iostat=status) F
      if (status /= 0) exit
      steps = steps + 1
      f1 = identity()
      f1(1, 1:2) = F(1:2)
      f1(2, 1:2) = F(3:4)
      call ask(point, transpose(f1), 2d0, ntens, stress, c, pnewdt)
      call ask(point, f1, 1d0, ntens, stress, c, pnewdt)
      call require(pnewdt == 1, "the point answers")
      status = set_time_step(state, 1d0)
      call require(evaluate(state, F, want_tangent_exact, P, A, report) == 0, "the library answers")
      full = 0
      full(1, 1:2) = P(1:2)
      full(2, 1:2) = P(3:4)
      sigma = matmul(full, transpose(f1))/determinant(f1)
      sigma = (sigma + transpose(sigma))/2
      do k = 1, ntens
        call require(abs(stress(k) - sigma(row(k), column(k))) <= 1d-13*norm2(sigma), "Cauchy stress")
      end do
      call accept(point, f1)
      status = commit(state)
    end do
    close (unit)
    call require(steps == 4, "four increments")
    call state_destroy(state)
  end subroutine

  ! DDSDDE against differences of the Kirchhoff stress along rates of deformation without spin.
  subroutine tangent(ntens, columns)
    integer, intent(in) :: ntens, columns(:)
    double precision, parameter :: step = 1d-7
    double precision :: f1(3, 3), d(3, 3), stress(ntens), c(ntens, ntens), unused(ntens, ntens), &
      kirchhoff(ntens, 2), pnewdt, factor, largest
    type(point_t) :: point
    integer :: k, m, side
    point%number = 10 + ntens
    f1 = identity()
    f1(1, 1:2) = [0.9996d0, 0.0003d0]
    f1(2, 1:2) = [-0.0001d0, 1.0002d0]
    call ask(point, f1, 1d0, ntens, stress, c, pnewdt)
    call require(pnewdt == 1, "the point answers")
    largest = 0
    do m = 1, size(columns)
      k = columns(m)
      do side = 1, 2
        d = 0
        factor = merge(step, -step, side == 1)
        d(row(k), column(k)) = factor/2
        d(column(k), row(k)) = d(column(k), row(k)) + factor/2
        call ask(point, matmul(identity() + d, f1), 1d0, ntens, stress, unused, pnewdt)
        call require(pnewdt == 1, "the point answers beside it")
        kirchhoff(:, side) = determinant(matmul(identity() + d, f1))*stress
      end do
      largest = max(largest, maxval(abs((kirchhoff(:, 1) - kirchhoff(:, 2))/ &
        (2*step*determinant(f1)) - c(:, k))))
    end do
    print '(a, i2, a, es8.1)', "NTENS", ntens, ": DDSDDE against differences", largest/norm2(c)
    call require(largest <= 1d-4*norm2(c), "DDSDDE is the derivative")
  end subroutine

  ! Simple shear beyond what the library takes at once: PNEWDT cuts it, to the bits of the same steps.
  subroutine cut
    double precision, parameter :: target = 0.7d0
    double precision :: f1(3, 3), stress(4), uncut(4), c(4, 4), pnewdt, shear, step, accepted(100)
    type(point_t) :: point, other
    integer :: cuts, n, k
    shear = 0
    step = target
    cuts = 0
    n = 0
    f1 = identity()
    do while (shear < target - 1d-9)
      f1(1, 2) = min(shear + step, target)
      call ask(point, f1, 1d0, 4, stress, c, pnewdt)
      if (pnewdt < 1) then
        call require(point%next_token == point%token, "STATEV stays")
        call require(pnewdt > 0, "PNEWDT is above 0")
        step = step*pnewdt
        cuts = cuts + 1
        call require(cuts < 10, "few cuts")
        cycle
      end if
      shear = f1(1, 2)
      call accept(point, f1)
      n = n + 1
      accepted(n) = shear
    end do
    call require(cuts > 0, "a cut")
    other%element = 2
    do k = 1, n
      f1(1, 2) = accepted(k)
      call ask(other, f1, 1d0, 4, uncut, c, pnewdt)
      call accept(other, f1)
    end do
    call require(all(stress == uncut), "the bits of the same steps uncut")
  end subroutine

  ! UEXTERNALDB writes the points of an increment and reads them in a job that goes on from it.
  subroutine restart
    double precision :: f1(3, 3), stress(4), again(4), c(4, 4), pnewdt
    type(point_t) :: point, kept
    integer :: k
    f1 = identity()
    do k = 1, 3
      f1(1, 2) = 2d-3*k
      f1(2, 2) = 1 - 1d-3*k
      call ask(point, f1, 1d0, 4, stress, c, pnewdt)
      call require(pnewdt == 1, "the point answers")
      call accept(point, f1)
      call uexternaldb(2, 1, [0d0, 0d0], 1d0, 1, k)
      if (k == 2) kept = point
    end do
    call uexternaldb(3, 0, [0d0, 0d0], 1d0, 1, 3)
    call uexternaldb(0, 0, [0d0, 0d0], 1d0, 1, 0)
    call uexternaldb(4, 0, [0d0, 0d0], 1d0, 1, 2)
    call ask(kept, f1, 1d0, 4, again, c, pnewdt)
    call require(pnewdt == 1, "the point answers after the restart")
    call require(all(again == stress), "the bits of the job that went on")
  end subroutine

  ! Each is told, asks for a smaller increment, and leaves the state as it was.
  subroutine bad_input
    double precision :: f1(3, 3), stress(4), expected(4), c(4, 4), c3(3, 3), stress3(3), pnewdt, nan
    type(point_t) :: point, wrong
    f1 = identity()
    f1(2, 2) = 0.999d0
    call ask(point, f1, 1d0, 4, expected, c, pnewdt)
    call accept(point, f1)
    f1(2, 2) = 0.998d0
    call ask(point, f1, 1d0, 4, expected, c, pnewdt)
    wrong = point
    wrong%token = 5
    call refused(wrong, f1)
    wrong = point
    wrong%f0(1, 2) = 1d-3
    call refused(wrong, f1)
    wrong = point
    wrong%element = 77
    call refused(wrong, f1)
    nan = 0
    nan = nan/nan
    f1(1, 2) = nan
    call refused(point, f1)
    f1(1, 2) = 0
    f1(3, 3) = 1.01d0
    call refused(point, f1)
    f1(3, 3) = 1
    call ask(point, f1, 1d0, 3, stress3, c3, pnewdt, 2)
    call require(pnewdt < 1, "plane stress is refused")
    call ask(point, f1, 1d0, 4, stress, c, pnewdt)
    call require(pnewdt == 1 .and. all(stress == expected), "the state as it was")
    call uexternaldb(4, 0, [0d0, 0d0], 1d0, 9, 9)
    call refused(point, f1)  ! no file of that increment
  end subroutine

  subroutine refused(point, f1)
    type(point_t), intent(inout) :: point
    double precision, intent(in) :: f1(3, 3)
    double precision :: stress(4), c(4, 4), pnewdt
    call ask(point, f1, 1d0, 4, stress, c, pnewdt)
    call require(pnewdt > 0 .and. pnewdt < 1, "a refusal")
    call require(point%next_token == point%token, "STATEV stays")
    call require(all(stress == 0), "STRESS stays")
  end subroutine
end program
