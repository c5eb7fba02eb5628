! A drained test on four Q4 elements around a node that is moved off the middle: Newton with the Jaumann
! tangent in the configuration of each iterate. One increment is refused and cut first.
program drained
  use material_point
  implicit none
  integer, parameter :: nodes = 9, unknowns = 2*nodes, steps = 4
  double precision, parameter :: pressure = 100d3, strain = 1d-3  ! Pa; of an increment
  integer, parameter :: corner(4, 4) = reshape([1, 2, 5, 4, 2, 3, 6, 5, 4, 5, 8, 7, 5, 6, 9, 8], [4, 4])
  double precision :: x(2, nodes), u(unknowns), force(steps), force_after_cut(steps)
  type(point_t) :: point(4, 4)
  integer :: a
  do a = 1, nodes
    x(:, a) = [0.5d0*mod(a - 1, 3), 0.5d0*((a - 1)/3)]
  end do
  x(:, 5) = [0.57d0, 0.46d0]
  call run(.false., 0, force)
  call run(.true., 100, force_after_cut)
  call require(all(force == force_after_cut), "a refused increment ends in the same bits")
  print '(a, 4f12.3)', "passed: drained, top force [N]", force
contains
  subroutine run(cuts, first_element, force)
    logical, intent(in) :: cuts
    integer, intent(in) :: first_element
    double precision, intent(out) :: force(steps)
    double precision :: u0(unknowns), du(unknowns), k(unknowns, unknowns), inner(unknowns), &
      outer(unknowns), residual, pnewdt
    logical :: prescribed(unknowns)
    integer :: e, q, step, iteration
    do e = 1, 4
      do q = 1, 4
        point(q, e) = point_t()
        point(q, e)%element = first_element + e
        point(q, e)%number = q
      end do
    end do
    outer = 0
    outer([5, 11, 17]) = -pressure*[0.25d0, 0.5d0, 0.25d0]
    prescribed = .false.
    prescribed([1, 7, 13, 2, 4, 6, 14, 16, 18]) = .true.
    u = 0
    do step = 1, steps
      u0 = u
      if (cuts .and. step == 2) then
        u([14, 16, 18]) = -0.4d0
        call assemble(u, k, inner, pnewdt)
        call require(pnewdt < 1, "an increment of 40 % is refused")
        u = u0
      end if
      du = 0
      du([14, 16, 18]) = -strain
      call assemble(u, k, inner, pnewdt)
      do iteration = 1, 12
        call require(pnewdt == 1, "all points answer")
        call solve(k, outer - inner, prescribed, du)
        u = u + du
        du = 0
        call assemble(u, k, inner, pnewdt)
        residual = norm2(pack(outer - inner, .not. prescribed))/norm2(inner)
        if (residual < 1d-10) exit
      end do
      print '(a, i2, a, i3, a, es8.1)', "step", step, ":", iteration, " iterations, residual", residual
      call require(residual < 1d-10 .and. iteration <= 6, "Newton is quadratic")
      call check_mean
      force(step) = sum(inner([14, 16, 18]))
      call accept_all
    end do
  end subroutine

  ! The mean of P11 is the pressure on the side: no other force acts along x but at x = 0.
  subroutine check_mean
    double precision :: stress(4), c(4, 4), f1(3, 3), pnewdt, sigma(2, 2), g(2, 4), volume, mean, &
      none(2, nodes)
    integer :: e, q
    none = 0
    mean = 0
    do e = 1, 4
      do q = 1, 4
        f1 = gradient(e, q, u)
        call ask(point(q, e), f1, 1d0, 4, stress, c, pnewdt)
        call shape_gradients(e, q, none, g, volume)
        sigma = reshape(stress([1, 4, 4, 2]), [2, 2])
        mean = mean + volume*(sigma(1, 1)*f1(2, 2) - sigma(1, 2)*f1(1, 2))
      end do
    end do
    call require(abs(mean + pressure) <= 1d-9*pressure, "the pressure of the side")
  end subroutine

  subroutine accept_all
    integer :: e, q
    do e = 1, 4
      do q = 1, 4
        call accept(point(q, e), gradient(e, q, u))
      end do
    end do
  end subroutine

  subroutine assemble(u, k, inner, pnewdt)
    double precision, intent(in) :: u(unknowns)
    double precision, intent(out) :: k(unknowns, unknowns), inner(unknowns), pnewdt
    double precision :: f1(3, 3), g(2, 4), b(4, 8), c(4, 4), stress(4), sigma(2, 2), ratio, volume, &
      ke(8, 8), p
    integer :: e, q, a, bb, i, j, dof(8)
    k = 0
    inner = 0
    pnewdt = 1
    do e = 1, 4
      do a = 1, 4
        dof(2*a - 1:2*a) = 2*corner(a, e) - [1, 0]
      end do
      do q = 1, 4
        f1 = gradient(e, q, u)
        call ask(point(q, e), f1, 1d0, 4, stress, c, ratio)
        pnewdt = min(pnewdt, ratio)
        if (ratio < 1) cycle
        call shape_gradients(e, q, reshape(u, [2, nodes]), g, volume)
        sigma = reshape(stress([1, 4, 4, 2]), [2, 2])
        b = 0
        do a = 1, 4
          b(1, 2*a - 1) = g(1, a)
          b(2, 2*a) = g(2, a)
          b(4, 2*a - 1) = g(2, a)
          b(4, 2*a) = g(1, a)
        end do
        ke = matmul(transpose(b), matmul(c, b))
        ! sigma : (L^T L - 2 D D) of Abaqus' rate form.
        do a = 1, 4
          do bb = 1, 4
            p = dot_product(g(:, a), matmul(sigma, g(:, bb)))
            do i = 1, 2
              do j = 1, 2
                ke(2*a - 2 + i, 2*bb - 2 + j) = ke(2*a - 2 + i, 2*bb - 2 + j) + merge(p/2, 0d0, i == j) - &
                  (sigma(i, j)*dot_product(g(:, a), g(:, bb)) + dot_product(sigma(i, :), g(:, bb))*g(j, a) &
                  + dot_product(sigma(j, :), g(:, a))*g(i, bb))/2
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
  function gradient(e, q, u) result(f)
    integer, intent(in) :: e, q
    double precision, intent(in) :: u(unknowns)
    double precision :: f(3, 3), g(2, 4), volume, moved(2, nodes), none(2, nodes)
    none = 0
    moved = reshape(u, [2, nodes])
    call shape_gradients(e, q, none, g, volume)
    f = identity()
    f(1:2, 1:2) = f(1:2, 1:2) + matmul(moved(:, corner(:, e)), transpose(g))
  end function

  ! Gradients of the shape functions in the configuration x + moved, and the volume of the point.
  subroutine shape_gradients(e, q, moved, g, volume)
    integer, intent(in) :: e, q
    double precision, intent(in) :: moved(2, nodes)
    double precision, intent(out) :: g(2, 4), volume
    integer, parameter :: side(2, 4) = reshape([-1, -1, 1, -1, 1, 1, -1, 1], [2, 4])
    double precision :: at(2), n(2, 4), jacobian(2, 2), inverse(2, 2)
    integer :: a
    at = side(:, q)/sqrt(3d0)
    do a = 1, 4
      n(1, a) = side(1, a)*(1 + side(2, a)*at(2))/4
      n(2, a) = side(2, a)*(1 + side(1, a)*at(1))/4
    end do
    jacobian = matmul(x(:, corner(:, e)) + moved(:, corner(:, e)), transpose(n))
    volume = jacobian(1, 1)*jacobian(2, 2) - jacobian(1, 2)*jacobian(2, 1)
    inverse = reshape([jacobian(2, 2), -jacobian(2, 1), -jacobian(1, 2), jacobian(1, 1)], [2, 2])/volume
    g = matmul(transpose(inverse), n)
  end subroutine
end program
