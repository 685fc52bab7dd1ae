geomint: scene wall has no parameter "breaks"; see geomint list ./wall.system
