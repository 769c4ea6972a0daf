"""Extracts Debian's PREEMPT_RT kernel and the modules that the machine needs from its package into the build folder.

Nothing is installed: the package is downloaded, unpacked beside the build, and removed; the extracted files are small.
"""
import glob
import lzma
import os
import re
import shutil
import subprocess
import tempfile

# Modules in load order; their dependencies are added automatically.
MODULES = ("virtio_pci 9pnet_virtio 9p overlay virtio_rng "  # the host's files
           "dummy_hcd libcomposite usb_f_fs configfs "       # an emulated USB device
           "can can-dev can-raw vcan "                       # a CAN interface
           "uhid hid-cp2112 "                                # a USB adapter with eight GPIO lines
           "evdev joydev uinput "                            # a SpaceMouse and a gamepad
           "msr").split()                                    # counter of system management interrupts
META = "linux-image-rt-amd64"  # depends on the newest real-time kernel of the installed Debian
SLOW_S = 150                   # longest duration of a command here
PATIENCE = ("-o", "Acquire::http::Timeout=20", "-o", "Acquire::Retries=1")


class NotToBeHad(Exception):
    """The reason why the real-time kernel is not available, in one line."""


def _said(*command, cwd=None):
    """Runs a command with a time limit; returns (success, output)."""
    env = dict(os.environ, LC_ALL="C", PATH=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")
    try:
        done = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=SLOW_S, env=env)
    except OSError as e:
        raise NotToBeHad(f"{command[0]} cannot be run: {e.strerror}") from e
    except subprocess.TimeoutExpired as e:
        raise NotToBeHad(f"{' '.join(command[:2])} took longer than {SLOW_S} s") from e
    return done.returncode == 0, done.stdout


def _package():
    """The package of the kernel: TACT_HIL_KERNEL or the dependency of META; None if apt has none."""
    name = os.environ.get("TACT_HIL_KERNEL", META)
    if re.fullmatch(r"linux-image-\d+\.\d+\.\d\S*", name):
        return name
    _, text = _said("apt-cache", "depends", name)
    found = re.search(r"Depends: (linux-image-\d\S*)$", text, re.M)
    return found.group(1) if found else None


def _update_lists():
    if os.environ.get("TACT_NO_INSTALL") != "1":
        as_root = [] if os.geteuid() == 0 else ["sudo", "-n"]
        _said(*as_root, "apt-get", "update", "-qq", *PATIENCE)


def _download(package, folder):
    """Returns (path of the package or None, output of apt-get)."""
    good, text = _said("apt-get", "download", "-q", *PATIENCE, package, cwd=folder)
    debs = glob.glob(os.path.join(folder, "*.deb"))
    return (debs[0] if good and debs else None), text


def _unpack(deb, folder, kept):
    """Extracts vmlinuz, the modules and their list in load order from the package into the folder `kept`."""
    tree = os.path.join(folder, "tree")
    good, text = _said("dpkg", "-x", deb, tree)
    if not good:
        raise NotToBeHad(f"the kernel package cannot be unpacked: {text.strip()}")
    if not os.path.isdir(os.path.join(tree, "lib")):  # Debian 13 ships only /usr/lib
        os.symlink("usr/lib", os.path.join(tree, "lib"))
    version = os.listdir(os.path.join(tree, "lib/modules"))[0]
    _said("depmod", "-b", tree, version)
    os.makedirs(os.path.join(kept, "modules"))
    files = []
    for module in MODULES:
        good, text = _said("modprobe", "-d", tree, "-S", version, "--show-depends", module)
        if not good:
            raise NotToBeHad(f"the kernel package has no module {module}: {text.strip()}")
        for line in text.splitlines():
            if line.startswith("insmod ") and line.split()[1] not in files:
                files.append(line.split()[1])
    with open(os.path.join(kept, "modules.list"), "w", encoding="utf-8") as listed:
        for path in files:
            name = os.path.basename(path)
            with (lzma.open if path.endswith(".xz") else open)(path, "rb") as f:
                data = f.read()
            name = name.removesuffix(".xz")
            with open(os.path.join(kept, "modules", name), "wb") as f:
                f.write(data)
            listed.write(name + "\n")
    shutil.copy(os.path.join(tree, "boot/vmlinuz-" + version), os.path.join(kept, "vmlinuz"))


def _is_whole(kept):
    try:
        with open(os.path.join(kept, "wanted"), encoding="utf-8") as f:
            return f.read().split() == MODULES
    except OSError:
        return False


def get(cache):
    """Returns the folder with vmlinuz, modules.list and modules/; created by the first call. Raises NotToBeHad."""
    os.makedirs(cache, exist_ok=True)
    why = f"apt has no package {os.environ.get('TACT_HIL_KERNEL', META)}"
    for attempt in range(2):
        if attempt == 1:  # the package lists may be absent or outdated
            _update_lists()
        package = _package()
        if package is None:
            continue
        kept = os.path.join(cache, package)
        if _is_whole(kept):
            return kept
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            print(f"hil: fetching {package}", flush=True)
            deb, text = _download(package, folder)
            if deb is None:
                why = " ".join([f"{package} cannot be downloaded:", *text.split("\n")[-2:]]).strip()
                continue
            made = os.path.join(folder, "kept")
            _unpack(deb, folder, made)
            with open(os.path.join(made, "wanted"), "w", encoding="utf-8") as f:
                f.write(" ".join(MODULES))
            shutil.rmtree(kept, ignore_errors=True)
            os.rename(made, kept)
            return kept
    raise NotToBeHad(why)
