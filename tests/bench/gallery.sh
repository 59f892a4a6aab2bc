#!/usr/bin/env bash
# docs/gallery.md and its pictures, every built-in scene as it brings itself along: `tests/bench/gallery.sh`.
set -euo pipefail
cd "$(dirname "$0")/../.."
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
mkdir -p docs/gallery
{
  echo "# Gallery"
  echo
  echo "Every built-in scene as it brings itself along. \`tests/bench/gallery.sh\` makes the pictures and this page."
  ./run scenes | while read -r scene triangles _ description; do
    size=1280x720
    if [ "$scene" = forest ]; then size=960x540; fi # its leaves make a large file
    ./run render "$scene" --size $size -o "$scratch/$scene.exr" --quiet </dev/null
    mv "$scratch/$scene.png" docs/gallery
    # Where there are several lights, each has channels of its own.
    lights=$(grep -aoE 'airlight\.[a-z0-9-]+\.R' "$scratch/$scene.exr" | sort -u | wc -l) || true
    cat <<END

## $scene

![${description%; takes*}](gallery/$scene.png)

\`./run render $scene --size $size -o $scene.exr\`: $triangles triangles, $((lights > 1 ? lights : 1)) light$([ "$lights" -lt 2 ] || echo s)
END
  done
} >docs/gallery.md
