// Header of a NIfTI-1 file in one part. nifticlib computes the quaternion of the axes.
#include <nifti1_io.h>

#include <cstring>
#include <memory>

#include "ipc/base/error.hpp"
#include "prep/volume/write_volume.hpp"

namespace tact {

std::string nifti_file_header(const VolumeFile& v) {
    const int dims[8] = {
        3, static_cast<int>(v.size[0]), static_cast<int>(v.size[1]), static_cast<int>(v.size[2]), 1, 1, 1, 1};
    const std::unique_ptr<nifti_image, void (*)(nifti_image*)> image(nifti_make_new_nim(dims, DT_INT16, 0),
                                                                     &nifti_image_free);
    if (!image) throw StartupError("writing a NIfTI file", "no memory", "free some memory");
    mat44 to{};
    for (int row = 0; row < 3; ++row) {
        const float side = v.oriented && row < 2 ? -1.0F : 1.0F;  // LPS to RAS
        for (int a = 0; a < 3; ++a)
            to.m[row][a] = side * static_cast<float>(v.step_mm[static_cast<std::size_t>(a)][row]);
        to.m[row][3] = side * static_cast<float>(v.origin_mm[row]);
    }
    to.m[3][3] = 1.0F;
    image->sto_xyz = to;
    image->sform_code = image->qform_code = v.oriented ? NIFTI_XFORM_SCANNER_ANAT : NIFTI_XFORM_UNKNOWN;
    float d[3];
    nifti_mat44_to_quatern(to, &image->quatern_b, &image->quatern_c, &image->quatern_d, &image->qoffset_x,
                           &image->qoffset_y, &image->qoffset_z, &d[0], &d[1], &d[2], &image->qfac);
    image->dx = image->pixdim[1] = d[0];
    image->dy = image->pixdim[2] = d[1];
    image->dz = image->pixdim[3] = d[2];
    image->xyz_units = NIFTI_UNITS_MM;
    image->nifti_type = NIFTI_FTYPE_NIFTI1_1;
    v.content.copy(image->descrip, sizeof image->descrip - 1);
    nifti_1_header h = nifti_convert_nim2nhdr(image.get());
    h.vox_offset = 352.0F;
    std::string bytes(352, '\0');  // and four bytes that say: no extension
    std::memcpy(bytes.data(), &h, sizeof h);
    return bytes;
}

}  // namespace tact
