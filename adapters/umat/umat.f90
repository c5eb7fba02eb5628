! UMAT and UEXTERNALDB as Abaqus calls them. They need *USER MATERIAL, UNSYMM and *DEPVAR 1.
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, &
    time, dtime, temp, dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, &
    drot, pnewdt, celent, dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  use, intrinsic :: iso_c_binding
  implicit none
  character(len=80) :: cmname
  integer :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep, kinc
  double precision :: stress(ntens), statev(nstatv), ddsdde(ntens, ntens), sse, spd, scd, rpl, &
    ddsddt(ntens), drplde(ntens), drpldt, stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, &
    predef(*), dpred(*), props(*), coords(3), drot(3, 3), pnewdt, celent, dfgrd0(3, 3), dfgrd1(3, 3)
  interface
    subroutine point(material, element, number, f0, f1, dt, direct, shears, token, stress, ddsdde, &
        pnewdt) bind(c, name="grainlaw_umat_point")
      import
      character(kind=c_char), intent(in) :: material(*)
      integer(c_int), value :: element, number, direct, shears
      real(c_double), intent(in) :: f0(3, 3), f1(3, 3)
      real(c_double), value :: dt
      real(c_double), intent(inout) :: token, stress(*), ddsdde(*), pnewdt
    end subroutine
  end interface
  call point(trim(cmname)//c_null_char, noel, npt, dfgrd0, dfgrd1, dtime, ndi, nshr, statev(1), stress, &
    ddsdde, pnewdt)
end subroutine

subroutine uexternaldb(lop, lrestart, time, dtime, kstep, kinc)
  use, intrinsic :: iso_c_binding
  implicit none
  integer :: lop, lrestart, kstep, kinc
  double precision :: time(2), dtime
  interface
    subroutine event(lop, restart, step, increment) bind(c, name="grainlaw_umat_event")
      import
      integer(c_int), value :: lop, restart, step, increment
    end subroutine
  end interface
  call event(lop, lrestart, kstep, kinc)
end subroutine
