# PCL's viewer may be missing, as on a robot. Afterwards, the target pcl_visualization exists in the calling directory if
# it is there. Asked for in a scope of its own: where it is missing, PCL forgets what it has found of the rest.
function(pcl_floam_find_visualization)
  find_package(PCL 1.12 QUIET COMPONENTS visualization)
endfunction()
