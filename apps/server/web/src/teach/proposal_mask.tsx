// The brush for the proposal in hand.
import { proposal_mask, proposal_picture } from "../api/calls";
import { MaskEditor } from "./mask_editor";
import type { Teaching } from "./teaching";

interface Props {
  teaching: Teaching;
  on_corrected?: () => Promise<void>;
  on_close: () => void;
}

export function ProposalMask({ teaching, on_corrected, on_close }: Props) {
  const session = teaching.session.value;
  const proposal = teaching.proposal.value;
  if (!session || !proposal) return null;
  return (
    <MaskEditor
      picture={proposal_picture(session.session)}
      mask={proposal_mask(session.session)}
      width={proposal.width}
      height={proposal.height}
      on_close={on_close}
      on_save={async (mask) => {
        await teaching.correct_mask(mask);
        await on_corrected?.();
      }}
    />
  );
}
