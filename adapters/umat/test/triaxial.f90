! The triaxial test of adapters/biaxial/triaxial.toml through UMAT with NTENS = 6: two C3D8 of 2 x 2 x 2 points
! between rough platens, in the configuration of each iterate. What PNEWDT asks for is cut.
!
!   grainlaw_umat_triaxial MATERIAL.toml [PREFIX [STEPS [SHORTENING]]]
!
! prints the residuals of Newton's method, and writes PREFIX_force.csv and PREFIX_newton.csv.
program triaxial
  use material_point
  implicit none
  interface
    integer(c_int) function setenv(name, value, overwrite) bind(C)
      import
      character(kind=c_char), intent(in) :: name(*), value(*)
      integer(c_int), value :: overwrite
    end function
  end interface
  integer, parameter :: layers = 2, nodes = 4*(layers + 1), unknowns = 3*nodes
  double precision, parameter :: width = 0.05d0, height = 0.1d0, pressure = 100d3, tolerance = 1d-10
  ! Corners of a cell, round its bottom and round its top.
  integer, parameter :: side(3, 8) = reshape([-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, &
    1, 1, 1, -1, 1, 1], [3, 8])
  double precision :: x(3, nodes), u(unknowns), outer(unknowns), shortening
  logical :: prescribed(unknowns)
  type(point_t) :: point(8, layers)
  character(len=1000) :: argument, prefix
  integer :: a, i, q, e, steps, step, forces, residuals

  call get_command_argument(1, argument)
  call require(argument /= "", "a material is named")
  call require(setenv("GRAINLAW_MATERIAL_SAND"//c_null_char, trim(argument)//c_null_char, 1) == 0, "setenv")
  prefix = "triaxial"
  steps = 5
  shortening = 5d-4
  call get_command_argument(2, argument)
  if (argument /= "") prefix = argument
  call get_command_argument(3, argument)
  if (argument /= "") read (argument, *) steps
  call get_command_argument(4, argument)
  if (argument /= "") read (argument, *) shortening

  do a = 1, nodes
    x(:, a) = [width*(1 + side(1, 1 + mod(a - 1, 4)))/2, width*(1 + side(2, 1 + mod(a - 1, 4)))/2, &
      height/layers*((a - 1)/4)]
  end do
  prescribed = .false.
  prescribed(:12) = .true.
  prescribed(unknowns - 11:) = .true.
  outer = 0
  do a = 1, nodes  ! each node has a quarter of the faces around it
    do i = 1, 2
      outer(3*a - 3 + i) = pressure*width*height/layers/merge(4, 2, prescribed(3*a))*merge(1, -1, x(i, a) == 0)
    end do
  end do
  do e = 1, layers
    do q = 1, 8
      point(q, e)%element = e
      point(q, e)%number = q
    end do
  end do

  open (newunit=forces, file=trim(prefix)//"_force.csv", status="replace", action="write")
  open (newunit=residuals, file=trim(prefix)//"_newton.csv", status="replace", action="write")
  write (forces, '(a)') "step[-],fraction[-],top_z_displacement[m],top_z_force[N]"
  write (residuals, '(a)') "step[-],iteration[-],relative_residual[-]"
  u = 0
  do step = 0, steps
    call advance(dble(max(step - 1, 0))/steps, dble(step)/steps)
  end do
contains
  ! From a fraction of the shortening to another; an increment that is refused is tried again, smaller.
  subroutine advance(from, to)
    double precision, intent(in) :: from, to
    double precision :: done, part, ratio, share
    done = 0
    part = 1
    do while (done < 1)
      share = from + (to - from)*(done + part)
      call increment(share, (to - from)*part, part, ratio)
      if (ratio < 1) then
        print '(3a, f5.3, a)', "load ", short(share), ": refused, PNEWDT ", ratio, "; the step is cut"
        part = part*ratio
        call require(part > 1d-3, "an increment is not cut for ever")
      else
        done = done + part
        part = min(part, 1 - done)
      end if
    end do
  end subroutine

  ! Newton's method; the points keep where they are unless ratio is 1 on return.
  subroutine increment(load, share, dtime, ratio)
    double precision, intent(in) :: load, share, dtime
    double precision, intent(out) :: ratio
    double precision :: k(unknowns, unknowns), inner(unknowns), du(unknowns), u0(unknowns), residual(20)
    integer :: iteration
    u0 = u
    du = 0
    du(unknowns - 9::3) = -shortening*share
    call assemble(dtime, k, inner, ratio)
    do iteration = 1, size(residual)
      if (ratio < 1) exit
      call solve(k, outer - inner, prescribed, du)
      u = u + du
      du = 0
      call assemble(dtime, k, inner, ratio)
      if (ratio < 1) exit
      residual(iteration) = norm2(pack(outer - inner, .not. prescribed))/norm2(inner)
      if (residual(iteration) < tolerance) exit
    end do
    if (ratio == 1 .and. iteration > size(residual)) ratio = 0.5d0
    if (ratio < 1) then
      u = u0
      return
    end if
    do e = 1, layers
      do q = 1, 8
        call accept(point(q, e), gradient(e, q))
      end do
    end do
    print '(3a, f0.4, a, 20es9.1)', "load ", short(load), ": force ", sum(inner(unknowns - 9::3)), &
      " N, residuals", residual(:iteration)
    write (forces, '(i0, 3(",", es24.16))') step, load, -shortening*load, sum(inner(unknowns - 9::3))
    do i = 1, iteration
      write (residuals, '(i0, ",", i0, ",", es24.16)') step, i, residual(i)
    end do
  end subroutine

  ! A number in as few digits as it needs.
  function short(number) result(text)
    double precision, intent(in) :: number
    character(len=:), allocatable :: text
    character(len=12) :: long
    write (long, '(f12.6)') number
    text = trim(adjustl(long))
    do while (index("0.", text(len(text):)) > 0 .and. index(text, ".") > 0)
      text = text(:len(text) - 1)
    end do
  end function

  subroutine assemble(dtime, k, inner, pnewdt)
    double precision, intent(in) :: dtime
    double precision, intent(out) :: k(unknowns, unknowns), inner(unknowns), pnewdt
    double precision :: g(3, 8), b(6, 24), c(6, 6), stress(6), sigma(3, 3), ratio, volume, ke(24, 24), p
    integer :: aa, bb, ii, jj, s, dof(24)
    k = 0
    inner = 0
    pnewdt = 1
    do e = 1, layers
      dof = [(12*(e - 1) + s, s = 1, 24)]
      do q = 1, 8
        call ask(point(q, e), gradient(e, q), dtime, 6, stress, c, ratio)
        pnewdt = min(pnewdt, ratio)
        if (ratio < 1) cycle
        call shape_gradients(e, q, reshape(u, [3, nodes]), g, volume)
        b = 0
        do s = 1, 6
          sigma(row(s), column(s)) = stress(s)
          sigma(column(s), row(s)) = stress(s)
          do aa = 1, 8
            b(s, 3*aa - 3 + row(s)) = g(column(s), aa)
            b(s, 3*aa - 3 + column(s)) = g(row(s), aa)
          end do
        end do
        ke = matmul(transpose(b), matmul(c, b))
        ! sigma : (L^T L - 2 D D) of Abaqus' rate form.
        do aa = 1, 8
          do bb = 1, 8
            p = dot_product(g(:, aa), matmul(sigma, g(:, bb)))
            do ii = 1, 3
              do jj = 1, 3
                ke(3*aa - 3 + ii, 3*bb - 3 + jj) = ke(3*aa - 3 + ii, 3*bb - 3 + jj) + merge(p/2, 0d0, ii == jj) - &
                  (sigma(ii, jj)*dot_product(g(:, aa), g(:, bb)) + dot_product(sigma(ii, :), g(:, bb))*g(jj, aa) &
                  + dot_product(sigma(jj, :), g(:, aa))*g(ii, bb))/2
              end do
            end do
          end do
        end do
        k(dof, dof) = k(dof, dof) + volume*ke
        inner(dof) = inner(dof) + volume*matmul(transpose(b), stress)
      end do
    end do
  end subroutine

  ! F at a point of an element.
  function gradient(e, q) result(f)
    integer, intent(in) :: e, q
    double precision :: f(3, 3), g(3, 8), volume, moved(3, nodes), none(3, nodes)
    none = 0
    moved = reshape(u, [3, nodes])
    call shape_gradients(e, q, none, g, volume)
    f = identity() + matmul(moved(:, 4*e - 3:4*e + 4), transpose(g))
  end function

  ! Gradients of the shape functions in the configuration x + moved, and the volume of the point.
  subroutine shape_gradients(e, q, moved, g, volume)
    integer, intent(in) :: e, q
    double precision, intent(in) :: moved(3, nodes)
    double precision, intent(out) :: g(3, 8), volume
    double precision :: at(3), n(3, 8), jacobian(3, 3), inverse(3, 3)
    integer :: c, s, t, w
    at = side(:, q)/sqrt(3d0)
    do c = 1, 8
      do s = 1, 3
        t = 1 + mod(s, 3)
        w = 1 + mod(s + 1, 3)
        n(s, c) = side(s, c)*(1 + side(t, c)*at(t))*(1 + side(w, c)*at(w))/8
      end do
    end do
    jacobian = matmul(x(:, 4*e - 3:4*e + 4) + moved(:, 4*e - 3:4*e + 4), transpose(n))
    volume = determinant(jacobian)
    do s = 1, 3
      do t = 1, 3
        inverse(t, s) = (jacobian(1 + mod(s, 3), 1 + mod(t, 3))*jacobian(1 + mod(s + 1, 3), 1 + mod(t + 1, 3)) &
          - jacobian(1 + mod(s, 3), 1 + mod(t + 1, 3))*jacobian(1 + mod(s + 1, 3), 1 + mod(t, 3)))/volume
      end do
    end do
    g = matmul(transpose(inverse), n)
  end subroutine
end program
