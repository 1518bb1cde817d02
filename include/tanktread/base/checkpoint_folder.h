// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: checkpoints as folders on disk, which are whole or known to be damaged.

#ifndef tanktread_base_checkpoint_folder_h
#define tanktread_base_checkpoint_folder_h

#include <cstdint>
#include <string>
#include <vector>

namespace tanktread
{
  /** CRC-32 of some bytes. */
  std::uint32_t
  checksum(const std::string &bytes);

  /** A file of a checkpoint. */
  struct CheckpointPiece
  {
    std::string   name; // without folder
    std::uint64_t size = 0;
    std::uint32_t sum  = 0;
  };

  /** What a checkpoint says about itself, and what it consists of. */
  struct CheckpointManifest
  {
    std::string                  program; // name and version
    unsigned int                 step = 0;
    double                       time = 0.;
    std::vector<CheckpointPiece> pieces;
  };

  /** The files of a checkpoint as text with a sum of its own at the end, and back. Reading throws InputError for a text that is not what was written. */
  std::string
  manifest_text(const CheckpointManifest &manifest);
  CheckpointManifest
  read_manifest(const std::string &text);

  /**
   * Checkpoints of a run in its folder `run`: run/checkpoints/step_00000012 with the files of all ranks and `manifest.txt`. One that is being written is called step_00000012.part; it gets its name when
   * all is on disk, and then all but the last `n_kept` are removed. None of the members communicates.
   */
  class CheckpointFolder
  {
  public:
    static constexpr unsigned int n_kept = 2;

    explicit CheckpointFolder(const std::string &run);

    /** Makes the folder of a checkpoint to come, without what an interrupted one has left. To be called on one rank. Throws OutputError. */
    void
    begin(unsigned int step) const;

    /** Writes one of its files and waits until it is on disk. On any rank. Throws OutputError; nothing is left of the file then. */
    CheckpointPiece
    add(unsigned int step, const std::string &name, const std::string &bytes) const;

    /** Writes the manifest, gives the checkpoint its name and removes those before the last ones. To be called on one rank. Throws OutputError. */
    void
    finish(const CheckpointManifest &manifest) const;

    /** Removes what there is of a checkpoint that cannot be finished. */
    void
    abandon(unsigned int step) const;

    /** Removes the checkpoints of later steps. */
    void
    forget_after(unsigned int step) const;

    /** Names of the checkpoints, newest first; whether they are whole is not looked at. */
    std::vector<std::string>
    names() const;

    /** Throws InputError where there is none or it is damaged. */
    CheckpointManifest
    manifest(const std::string &name) const;

    /** The bytes of a file. Throws InputError where they are not those that were written. */
    std::string
    read(const std::string &name, const CheckpointPiece &piece) const;

    const std::string &
    path() const
    {
      return path_;
    }

  private:
    std::string
    unfinished(unsigned int step) const;

    std::string path_; // of the folder of all of them
  };
} // namespace tanktread

#endif
