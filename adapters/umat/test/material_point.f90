! One point of UMAT, as its host keeps it, and the checks that the tests share.
module material_point
  use, intrinsic :: iso_c_binding
  implicit none

  type :: point_t
    integer :: element = 1, number = 1
    double precision :: token = 0, next_token = 0
    double precision :: f0(3, 3) = reshape([1, 0, 0, 0, 1, 0, 0, 0, 1], [3, 3])
  end type

  integer, parameter :: row(6) = [1, 2, 3, 1, 1, 2], column(6) = [1, 2, 3, 2, 3, 3]
contains
  ! Asks a point at f1 from the start of its increment; pnewdt is 1 where it answers.
  subroutine ask(point, f1, dtime, ntens, stress, ddsdde, pnewdt, direct)
    type(point_t), intent(inout) :: point
    double precision, intent(in) :: f1(3, 3), dtime
    integer, intent(in) :: ntens
    double precision, intent(out) :: stress(ntens), ddsdde(ntens, ntens), pnewdt
    integer, intent(in), optional :: direct
    double precision :: statev(1), none, zeros(6), zero_2(2), zero_3(3), zero_33(3, 3)
    character(len=80) :: name
    integer :: ndi
    ndi = 3
    if (present(direct)) ndi = direct
    name = "SAND"
    statev = point%token
    stress = 0
    ddsdde = 0
    none = 0
    zeros = 0
    zero_2 = 0
    zero_3 = 0
    zero_33 = 0
    pnewdt = 1
    call umat(stress, statev, ddsdde, none, none, none, none, zeros, zeros, none, zeros, zeros, zero_2, &
      dtime, none, none, zeros, zeros, name, ndi, ntens - 3, ntens, 1, zeros, 0, zero_3, zero_33, pnewdt, &
      none, point%f0, f1, point%element, point%number, 1, 1, 1, 1)
    point%next_token = statev(1)
  end subroutine

  subroutine accept(point, f1)
    type(point_t), intent(inout) :: point
    double precision, intent(in) :: f1(3, 3)
    point%token = point%next_token
    point%f0 = f1
  end subroutine

  subroutine require(condition, what)
    logical, intent(in) :: condition
    character(len=*), intent(in) :: what
    if (condition) return
    print '(2a)', "FAILED: ", what
    stop 1
  end subroutine

  pure function identity() result(one)
    double precision :: one(3, 3)
    one = reshape([1d0, 0d0, 0d0, 0d0, 1d0, 0d0, 0d0, 0d0, 1d0], [3, 3])
  end function

  pure double precision function determinant(m)
    double precision, intent(in) :: m(3, 3)
    determinant = m(1, 1)*(m(2, 2)*m(3, 3) - m(2, 3)*m(3, 2)) + m(1, 2)*(m(2, 3)*m(3, 1) - &
      m(2, 1)*m(3, 3)) + m(1, 3)*(m(2, 1)*m(3, 2) - m(2, 2)*m(3, 1))
  end function

  ! k du = right for the free components; those that are prescribed are in du.
  subroutine solve(k, right, prescribed, du)
    double precision, intent(in) :: k(:, :), right(:)
    logical, intent(in) :: prescribed(:)
    double precision, intent(inout) :: du(:)
    double precision :: m(size(du), size(du) + 1), line(size(du) + 1)
    integer :: i, j, pivot, unknowns
    unknowns = size(du)
    m(:, :unknowns) = k
    m(:, unknowns + 1) = right
    do i = 1, unknowns
      if (.not. prescribed(i)) cycle
      m(i, :) = 0
      m(i, i) = maxval(abs(k))
      m(i, unknowns + 1) = m(i, i)*du(i)
    end do
    do i = 1, unknowns
      pivot = i - 1 + maxloc(abs(m(i:, i)), 1)
      line = m(i, :)
      m(i, :) = m(pivot, :)
      m(pivot, :) = line
      do j = i + 1, unknowns
        m(j, :) = m(j, :) - m(j, i)/m(i, i)*m(i, :)
      end do
    end do
    do i = unknowns, 1, -1
      du(i) = (m(i, unknowns + 1) - dot_product(m(i, i + 1:unknowns), du(i + 1:)))/m(i, i)
    end do
  end subroutine
end module
