# Fuzz targets of deploy.
