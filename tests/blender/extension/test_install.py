# The extension installs from its .zip, enables, disables, goes, and comes again; it leaves nothing registered behind.
import sys

import bpy
import session

zip_path = sys.argv[1]
bpy.ops.wm.read_factory_settings()
for _ in range(2):
    bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
    assert session.MODULE in bpy.context.preferences.addons
    assert hasattr(bpy.types.Scene, "impasto") and hasattr(bpy.types, "IMPASTO_PT_painting")
    bpy.context.scene.render.engine = "IMPASTO"
    for _ in range(2):
        bpy.ops.preferences.addon_disable(module=session.MODULE)
        assert not hasattr(bpy.types.Scene, "impasto") and not hasattr(bpy.types, "IMPASTO_PT_painting")
        bpy.ops.preferences.addon_enable(module=session.MODULE)
    index = next(index for index, repo in enumerate(bpy.context.preferences.extensions.repos) if repo.module == "user_default")
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id="impasto")
    assert session.MODULE not in bpy.context.preferences.addons
bpy.ops.extensions.package_install_files(filepath=zip_path, repo="user_default", enable_on_install=True)
bpy.ops.wm.save_userpref()
session.report("installs, enables, disables, uninstalls, and again")
