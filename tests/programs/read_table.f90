! Prints the names of materials and the shape and sum of DOLP of a table over material, theta, sigma and q: read_table TABLE.nc
program read_table
  use netcdf
  implicit none
  character(len=1024) :: path
  character(len=:), allocatable :: names(:)
  double precision, allocatable :: dolp(:, :, :, :)
  integer :: table, variable, count, i
  integer :: dimensions(nf90_max_var_dims), lengths(nf90_max_var_dims)

  call get_command_argument(1, path)
  call check(nf90_open(trim(path), nf90_nowrite, table))
  call find("material_name")
  allocate (character(len=lengths(1)) :: names(lengths(2)))
  call check(nf90_get_var(table, variable, names))
  print '(a)', names
  call find("dolp")
  allocate (dolp(lengths(1), lengths(2), lengths(3), lengths(4)))
  call check(nf90_get_var(table, variable, dolp))
  print *, shape(dolp), sum(dolp)

contains

  subroutine find(name)
    character(len=*), intent(in) :: name
    call check(nf90_inq_varid(table, name, variable))
    call check(nf90_inquire_variable(table, variable, ndims=count, dimids=dimensions))
    do i = 1, count
      call check(nf90_inquire_dimension(table, dimensions(i), len=lengths(i)))
    end do
  end subroutine

  subroutine check(status)
    integer, intent(in) :: status
    if (status /= nf90_noerr) stop nf90_strerror(status)
  end subroutine
end program
