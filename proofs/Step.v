(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Steps of many robots. The plane is divided again and again, and what lies in different parts cannot meet: wherever it
   is divided, no pair is left out, so that the places need no proof. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems Plane Parity Route.
Import ListNotations.
Open Scope R_scope.

(* --- Two robots, a robot and an edge --- *)
Definition way_of (m : motion) : edge := (from m, to m).
Definition robots_apart (a b : motion) : bool :=
  let z := Qmake 0 (Qden (size a)) in
  segments_apart (qadd (size a) (size b)) (psub (from a) (from b), psub (to a) (to b)) ((z, z), (z, z)).

Definition robots_keep (a b : motion) := forall s, 0 <= s <= 1 -> apart (Q2R (size a) + Q2R (size b)) (place a s) (place b s).
Definition edge_keeps (a : motion) (e : edge) := forall s y, 0 <= s <= 1 -> on e y -> apart (Q2R (size a)) (place a s) y.

Lemma place_on m s : 0 <= s <= 1 -> on (way_of m) (place m s).
Proof. intro hs. unfold way_of. apply on_mix. now exists s. Qed.

Lemma robots_apart_ok a b : robots_apart a b = true -> robots_keep a b.
Proof.
  unfold robots_apart. set (z := Qmake 0 (Qden (size a))). intros h s hs. apply segments_apart_ok in h. destruct h as [_ h].
  rewrite Q2R_add in h. assert (ez : Q2R z = 0) by (unfold z, Q2R; simpl; lra).
  specialize (h (mix s (real (psub (from a) (from b))) (real (psub (to a) (to b)))) (real (z, z))).
  assert (k : apart (Q2R (size a) + Q2R (size b)) (mix s (real (psub (from a) (from b))) (real (psub (to a) (to b)))) (real (z, z))).
  { apply h; [apply on_mix; now exists s|apply (on_first ((z, z), (z, z)))]. }
  rewrite !real_sub in k. assert (origin : real (z, z) = (0, 0)) by (unfold real; simpl; now rewrite ez). rewrite origin in k.
  unfold apart, place, dot, sub, mix, add, scale in *; simpl in *. lra.
Qed.
Lemma edge_apart_ok a e : segments_apart (size a) (way_of a) e = true -> edge_keeps a e.
Proof. intros h s y hs hy. apply segments_apart_ok in h. destruct h as [_ h]. apply h; [now apply place_on|assumption]. Qed.

(* --- Boxes --- *)
Record box := { x0 : Q; x1 : Q; y0 : Q; y1 : Q }.
Definition boxes_part (a b : box) : bool := qle (x1 a) (x0 b) || qle (x1 b) (x0 a) || qle (y1 a) (y0 b) || qle (y1 b) (y0 a).
Definition box_of (r : Q) (e : edge) : box :=
  {| x0 := qsub (qmin (fst (fst e)) (fst (snd e))) r; x1 := qadd (qmax (fst (fst e)) (fst (snd e))) r;
     y0 := qsub (qmin (snd (fst e)) (snd (snd e))) r; y1 := qadd (qmax (snd (fst e)) (snd (snd e))) r |}.

Definition fills (r : Q) (b : box) (x : vec) :=
  Q2R (x0 b) + Q2R r <= fst x <= Q2R (x1 b) - Q2R r /\ Q2R (y0 b) + Q2R r <= snd x <= Q2R (y1 b) - Q2R r.

Lemma mix_bounds s u v : 0 <= s <= 1 -> Rmin u v <= (1 - s) * u + s * v <= Rmax u v.
Proof. intro hs. unfold Rmin, Rmax. destruct (Rle_dec u v).
  - assert (0 <= s * (v - u) <= 1 * (v - u)) by (split; [apply Rmult_le_pos|apply Rmult_le_compat_r]; lra). lra.
  - assert (0 <= s * (u - v) <= 1 * (u - v)) by (split; [apply Rmult_le_pos|apply Rmult_le_compat_r]; lra). lra.
Qed.

Lemma box_of_ok r e x : on e x -> fills r (box_of r e) x.
Proof.
  destruct e as [a b]. intro h. apply on_mix in h. destruct h as [s [hs ex]]. subst. unfold fills, box_of; simpl.
  rewrite !Q2R_add, !Q2R_sub, !Q2R_min, !Q2R_max.
  pose proof (mix_bounds s (Q2R (fst a)) (Q2R (fst b)) hs). pose proof (mix_bounds s (Q2R (snd a)) (Q2R (snd b)) hs). lra.
Qed.

Lemma boxes_part_ok a b r q x y : boxes_part a b = true -> fills r a x -> fills q b y -> 0 <= Q2R r -> 0 <= Q2R q ->
  apart (Q2R r + Q2R q) x y.
Proof.
  unfold boxes_part, fills. rewrite !orb_true_iff. intros h [ax ay] [bx by_] r0 q0.
  unfold apart, dot, sub; simpl. destruct h as [[[h|h]|h]|h]; apply qle_R in h;
  [| | rewrite (Rplus_comm ((fst x - fst y) * _)) | rewrite (Rplus_comm ((fst x - fst y) * _))]; (apply leg; [lra|]); [right|left|right|left]; lra.
Qed.

(* --- map and filter for lists of a million: as OCaml they need no stack --- *)
Definition each {A B} (f : A -> B) (l : list A) : list B := rev' (fold_left (fun done a => f a :: done) l []).
Definition sift {A} (f : A -> bool) (l : list A) : list A := rev' (fold_left (fun done a => if f a then a :: done else done) l []).

Lemma each_map {A B} (f : A -> B) l : each f l = map f l.
Proof.
  assert (h : forall done, fold_left (fun done a => f a :: done) l done = rev (map f l) ++ done).
  { induction l as [|a t ih]; intro done; simpl; [reflexivity|]. now rewrite ih, <- app_assoc. }
  unfold each, rev'. now rewrite <- rev_alt, h, app_nil_r, rev_involutive.
Qed.
Lemma sift_filter {A} (f : A -> bool) l : sift f l = filter f l.
Proof.
  assert (h : forall done, fold_left (fun done a => if f a then a :: done else done) l done = rev (filter f l) ++ done).
  { induction l as [|a t ih]; intro done; simpl; [reflexivity|]. rewrite ih. destruct (f a); simpl; [now rewrite <- app_assoc|reflexivity]. }
  unfold sift, rev'. now rewrite <- rev_alt, h, app_nil_r, rev_involutive.
Qed.

(* --- Things: their boxes, and how the plane is divided among them --- *)
Definition robot := (box * motion)%type.
Definition wall := (box * edge)%type.
Definition pair_holds (a b : robot) : bool := boxes_part (fst a) (fst b) || robots_apart (snd a) (snd b).
Definition wall_holds (a : robot) (w : wall) : bool := boxes_part (fst a) (fst w) || segments_apart (size (snd a)) (way_of (snd a)) (snd w).
Fixpoint all_pairs (l : list robot) : bool :=
  match l with [] => true | a :: t => forallb (pair_holds a) t && all_pairs t end.

Definition lows (upright : bool) (p : Q) (b : box) : bool := qle (if upright then y0 b else x0 b) p.
Definition highs (upright : bool) (p : Q) (b : box) : bool := qle p (if upright then y1 b else x1 b).

(* Where to divide: the middle of all, across the longer side. *)
Definition around (b c : box) : box :=
  {| x0 := qmin (x0 b) (x0 c); x1 := qmax (x1 b) (x1 c); y0 := qmin (y0 b) (y0 c); y1 := qmax (y1 b) (y1 c) |}.
Definition middle (a b : Q) : Q := Qmake (Z.div2 (Qnum a + Qnum b)) (Qden a).

Fixpoint longer {A B} (l : list A) (than : list B) : bool :=
  match l, than with _ :: t, _ :: k => longer t k | [], _ => false | _ :: _, [] => true end.

Definition cut (l : list robot) : option (bool * Q) :=
  match l with
  | a :: t => if longer t [tt; tt; tt; tt; tt; tt; tt; tt] then
      let b := fold_left (fun b r => around b (fst r)) t (fst a) in
      if qle (qsub (x1 b) (x0 b)) (qsub (y1 b) (y0 b)) then Some (true, middle (y0 b) (y1 b)) else Some (false, middle (x0 b) (x1 b))
    else None
  | [] => None
  end.
Definition part {A} (reaches : box -> bool) (l : list (box * A)) := sift (fun r => reaches (fst r)) l.

Definition undivided (l : list robot) (ws : list wall) : bool :=
  all_pairs l && forallb (fun w => forallb (fun a => wall_holds a w) l) ws.
Fixpoint divide (fuel : nat) (l : list robot) (ws : list wall) : bool :=
  match fuel, cut l with
  | S k, Some (u, p) =>
      let low := part (lows u p) l in let high := part (highs u p) l in
      if longer l low && longer l high
      then divide k low (part (lows u p) ws) && divide k high (part (highs u p) ws) else undivided l ws
  | _, _ => undivided l ws
  end.

Definition boxed (m : motion) : robot := (box_of (size m) (way_of m), m).
Definition step_apart (es : list edge) (discs ms : list motion) : bool :=
  forallb (fun m => qlt 0 (size m)) ms && let l := each boxed ms in
  divide 64 l (each (fun e => (box_of 0 e, e)) es)
  && forallb (fun d => qle 0 (size d) && let b := boxed d in forallb (pair_holds b) l) discs.
Definition step (os : list obstacle) (discs ms : list motion) : bool := step_apart (flat_map edges_of os) discs ms.

(* Once outside of all polygons, robots that keep clear of the edges stay so: only at the start this is asked. *)
Definition starts (os : list obstacle) (ms : list motion) : bool :=
  forallb (fun o => let es := edges_of o in forallb (fun m => is_outside o es (from m)) ms) os.

(* --- No pair is left out --- *)
Definition well_boxed (a : robot) := 0 <= Q2R (size (snd a)) /\ forall x, on (way_of (snd a)) x -> fills (size (snd a)) (fst a) x.
Definition well_walled (w : wall) := forall x, on (snd w) x -> fills 0 (fst w) x.
Definition good (a b : robot) := robots_keep (snd a) (snd b).
Definition good_wall (a : robot) (w : wall) := edge_keeps (snd a) (snd w).

Lemma parted_robots a b : well_boxed a -> well_boxed b -> boxes_part (fst a) (fst b) = true -> good a b.
Proof.
  intros [a0 ha] [b0 hb] h s hs. apply boxes_part_ok with (1 := h); try assumption; [apply ha|apply hb]; now apply place_on.
Qed.
Lemma parted_wall a w : well_boxed a -> well_walled w -> boxes_part (fst a) (fst w) = true -> good_wall a w.
Proof.
  intros [a0 ha] hw h s y hs hy. pose proof (boxes_part_ok _ _ _ _ (place (snd a) s) y h (ha _ (place_on _ _ hs)) (hw y hy) a0) as k.
  rewrite Q2R_0, Rplus_0_r in k. apply k. lra.
Qed.
Lemma pair_ok a b : well_boxed a -> well_boxed b -> pair_holds a b = true -> good a b.
Proof. intros ha hb h. apply orb_true_iff in h. destruct h as [h|h]; [now apply parted_robots|now apply robots_apart_ok]. Qed.
Lemma wall_ok a w : well_boxed a -> well_walled w -> wall_holds a w = true -> good_wall a w.
Proof. intros ha hw h. apply orb_true_iff in h. destruct h as [h|h]; [now apply parted_wall|now apply edge_apart_ok]. Qed.

Lemma all_pairs_ok l : Forall well_boxed l -> all_pairs l = true -> ForallOrdPairs good l.
Proof.
  induction l as [|a t ih]; intros hw h; constructor; simpl in h; apply andb_true_iff in h; destruct h as [h1 h2]; inversion hw; subst.
  - apply Forall_forall. intros b hb. rewrite forallb_forall in h1. rewrite Forall_forall in H2. apply pair_ok; auto.
  - now apply ih.
Qed.

Lemma qle_flip a b : qle a b = false -> qle b a = true.
Proof. intro h. apply qle_iff. assert (k : qlt b a = true) by (unfold qlt; now rewrite h). apply qlt_R in k. lra. Qed.
Lemma qle_trans a b c : qle a b = true -> qle b c = true -> qle a c = true.
Proof. rewrite !qle_iff. lra. Qed.

(* Two boxes are parted, or both reach below, or both above. *)
Lemma sides_part u p a b : boxes_part a b = true \/ (lows u p a = true /\ lows u p b = true) \/ (highs u p a = true /\ highs u p b = true)
  \/ (lows u p a = false /\ highs u p a = false) \/ (lows u p b = false /\ highs u p b = false).
Proof.
  unfold boxes_part, lows, highs. rewrite !orb_true_iff.
  set (a0 := if u then y0 a else x0 a). set (a1 := if u then y1 a else x1 a). set (b0 := if u then y0 b else x0 b). set (b1 := if u then y1 b else x1 b).
  destruct (qle a0 p) eqn:ha, (qle b0 p) eqn:hb, (qle p a1) eqn:ka, (qle p b1) eqn:kb; auto 6; left.
  - assert (k : qle a1 b0 = true) by (apply qle_trans with p; now apply qle_flip). unfold a1, b0 in k. destruct u; auto.
  - assert (k : qle b1 a0 = true) by (apply qle_trans with p; now apply qle_flip). unfold b1, a0 in k. destruct u; auto.
Qed.

Lemma well_boxed_side u p a : well_boxed a -> lows u p (fst a) = true \/ highs u p (fst a) = true.
Proof.
  intros [r0 h]. specialize (h _ (on_first (way_of (snd a)))). unfold fills in h. unfold lows, highs.
  destruct u; destruct (qle _ p) eqn:e; auto; right; apply qle_flip in e; apply qle_trans with (1 := e); apply qle_iff; lra.
Qed.
Lemma well_walled_side u p w : well_walled w -> lows u p (fst w) = true \/ highs u p (fst w) = true.
Proof.
  intros h. specialize (h _ (on_first (snd w))). unfold fills in h. rewrite Q2R_0 in h. unfold lows, highs.
  destruct u; destruct (qle _ p) eqn:e; auto; right; apply qle_flip in e; apply qle_trans with (1 := e); apply qle_iff; lra.
Qed.

Lemma filtered_pairs {A} (R : A -> A -> Prop) f g l :
  (forall a b, In a l -> In b l -> R a b \/ (f a = true /\ f b = true) \/ (g a = true /\ g b = true)) ->
  ForallOrdPairs R (filter f l) -> ForallOrdPairs R (filter g l) -> ForallOrdPairs R l.
Proof.
  induction l as [|a t ih]; intros h hf hg; constructor.
  - apply Forall_forall. intros b hb. destruct (h a b (or_introl eq_refl) (or_intror hb)) as [k|[[fa fb]|[ga gb]]]; [assumption| |].
    + simpl in hf. rewrite fa in hf. inversion hf as [|? ? k _]; subst. rewrite Forall_forall in k. apply k, filter_In. now split.
    + simpl in hg. rewrite ga in hg. inversion hg as [|? ? k _]; subst. rewrite Forall_forall in k. apply k, filter_In. now split.
  - apply ih; [intros; apply h; now right| |]; simpl in *.
    + destruct (f a); [now inversion hf|assumption].
    + destruct (g a); [now inversion hg|assumption].
Qed.

Lemma Forall_filter {A} (P : A -> Prop) f l : Forall P l -> Forall P (filter f l).
Proof. rewrite !Forall_forall. intros h x hx. apply filter_In in hx. now apply h. Qed.

Theorem divide_ok fuel : forall l ws, Forall well_boxed l -> Forall well_walled ws -> divide fuel l ws = true ->
  ForallOrdPairs good l /\ forall a w, In a l -> In w ws -> good_wall a w.
Proof.
  assert (base : forall l ws, Forall well_boxed l -> Forall well_walled ws ->
    undivided l ws = true -> ForallOrdPairs good l /\ forall a w, In a l -> In w ws -> good_wall a w).
  { intros l ws hl hw h. unfold undivided in h. apply andb_true_iff in h. destruct h as [h k]. split; [now apply all_pairs_ok|].
    intros a w ha hw'. rewrite forallb_forall in k. specialize (k w hw'). rewrite forallb_forall in k.
    rewrite Forall_forall in hl, hw. apply wall_ok; auto. }
  induction fuel as [|k ih]; intros l ws hl hw h; simpl in h; [now apply base|].
  destruct (cut l) as [[u p]|]; [|now apply base].
  match type of h with (if ?c then _ else _) = true => destruct c end; [|now apply base]. unfold part in h. rewrite !sift_filter in h.
  apply andb_true_iff in h. destruct h as [h1 h2].
  apply ih in h1; [|now apply Forall_filter|now apply Forall_filter]. apply ih in h2; [|now apply Forall_filter|now apply Forall_filter].
  destruct h1 as [f1 w1], h2 as [f2 w2]. rewrite Forall_forall in hl, hw. split.
  - apply (filtered_pairs good (fun r => lows u p (fst r)) (fun r => highs u p (fst r))); [|exact f1|exact f2].
    intros x y hx hy. destruct (sides_part u p (fst x) (fst y)) as [q|[q|[q|[[q1 q2]|[q1 q2]]]]]; auto.
    + left. apply parted_robots; auto.
    + exfalso. destruct (well_boxed_side u p x (hl x hx)); congruence.
    + exfalso. destruct (well_boxed_side u p y (hl y hy)); congruence.
  - intros x w hx hw'. destruct (sides_part u p (fst x) (fst w)) as [q|[[q1 q2]|[[q1 q2]|[[q1 q2]|[q1 q2]]]]].
    + apply parted_wall; auto.
    + apply w1; apply filter_In; now split.
    + apply w2; apply filter_In; now split.
    + exfalso. destruct (well_boxed_side u p x (hl x hx)); congruence.
    + exfalso. destruct (well_walled_side u p w (hw w hw')); congruence.
Qed.

Lemma pairs_map {A B} (f : A -> B) (R : B -> B -> Prop) l : ForallOrdPairs R (map f l) -> ForallOrdPairs (fun a b => R (f a) (f b)) l.
Proof.
  induction l as [|a t ih]; simpl; intro h; constructor; inversion h as [|? ? h1 h2]; subst; [|now apply ih].
  rewrite Forall_forall in *. intros x hx. apply h1. now apply in_map.
Qed.
Lemma pairs_impl {A} (R S : A -> A -> Prop) l : (forall a b, R a b -> S a b) -> ForallOrdPairs R l -> ForallOrdPairs S l.
Proof. intros i h. induction h as [|a l ha _ ih]; constructor; [|assumption]. apply Forall_impl with (2 := ha). apply i. Qed.

Lemma boxed_ok m : 0 <= Q2R (size m) -> well_boxed (boxed m).
Proof. intro h. split; [exact h|]. intros x hx. now apply box_of_ok. Qed.

Lemma step_apart_ok es discs ms : step_apart es discs ms = true ->
  (forall m, In m ms -> 0 < Q2R (size m)) /\ ForallOrdPairs robots_keep ms /\ (forall m e, In m ms -> In e es -> edge_keeps m e)
  /\ forall d m, In d discs -> In m ms -> robots_keep d m.
Proof.
  unfold step_apart. rewrite !each_map. intro h. apply andb_true_iff in h. destruct h as [r0 h]. apply andb_true_iff in h.
  destruct h as [h hd]. rewrite forallb_forall in r0, hd.
  assert (p : forall m, In m ms -> 0 < Q2R (size m)).
  { intros m hm. specialize (r0 m hm). apply qlt_R in r0. now rewrite Q2R_0 in r0. }
  assert (w : Forall well_boxed (map boxed ms)).
  { apply Forall_forall. intros x hx. apply in_map_iff in hx. destruct hx as [m [e hm]]. subst x. apply boxed_ok. left. now apply p. }
  split; [exact p|]. apply divide_ok in h; [|exact w|].
  - destruct h as [h1 h2]. split; [apply pairs_map in h1; exact h1|]. split.
    + intros m e hm he. apply (h2 (boxed m) (box_of 0 e, e)); [now apply in_map|]. now apply (in_map (fun e => (box_of 0 e, e))).
    + intros d m hd' hm. specialize (hd d hd'). apply andb_true_iff in hd. destruct hd as [d0 hd]. apply qle_R in d0. rewrite Q2R_0 in d0.
      rewrite forallb_forall in hd. rewrite Forall_forall in w. apply (in_map boxed) in hm.
      exact (pair_ok (boxed d) (boxed m) (boxed_ok d d0) (w _ hm) (hd _ hm)).
  - apply Forall_forall. intros x hx. apply in_map_iff in hx. destruct hx as [e [k he]]. subst x. intros x hx. now apply box_of_ok.
Qed.

Theorem starts_sound os ms : starts os ms = true -> forall m, In m ms -> outside os (place m 0).
Proof.
  unfold starts. intros h m hm o ho. rewrite forallb_forall in h. specialize (h o ho). simpl in h. rewrite forallb_forall in h.
  unfold place. rewrite mix_0. apply is_outside_ok. now apply h.
Qed.

Theorem step_sound os discs ms : step os discs ms = true -> (forall m, In m ms -> outside os (place m 0)) -> keeps_apart os discs ms.
Proof.
  unfold step. intros h start s hs. apply step_apart_ok in h. destruct h as [p [h1 [h2 h3]]].
  assert (k : forall m o e x y, In m ms -> In o os -> In e (edges_of o) -> on (way_of m) x -> on e y -> apart (Q2R (size m)) x y).
  { intros m o e x y hm ho he hx hy. apply on_mix in hx. destruct hx as [q [hq ex]]. subst x.
    apply (h2 m e hm); [|exact hq|exact hy]. apply in_flat_map. now exists o. }
  split; [apply pairs_impl with (2 := h1); intros a b q; now apply q|]. intros m hm.
  split; [|intros d hd; now apply (h3 d m)]. split.
  - intros o ho. specialize (start m hm o ho). destruct o as [l|rs]; [exact I|]. unfold place in start. rewrite mix_0 in start.
    apply (piece_even (Q2R (size m)) _ (from m) (to m) (rings_closed rs) (p m hm)); [|exact start|now apply place_on].
    intros e x y he hx hy. now apply (k m (Solid rs) e).
  - intros o e y ho he hy. apply (k m o e); auto. now apply place_on.
Qed.

(* --- Runs --- *)
Fixpoint steps (os : list obstacle) (discs : list motion) (sizes : list Q) (rows : list (list point)) : bool :=
  match rows with a :: ((b :: _) as r) => step os discs (moves sizes a b) && steps os discs sizes r | _ => true end.
Definition run (os : list obstacle) (discs : list motion) (sizes : list Q) (rows : list (list point)) : bool :=
  forallb (fun r => Nat.eqb (length r) (length sizes)) rows && steps os discs sizes (with_start rows)
  && match rows with a :: _ => starts os (moves sizes a a) | [] => true end.

(* Where a robot is at a row, it came from the row before. *)
Lemma came_from sizes : forall a b c, length a = length sizes -> length b = length sizes -> forall m, In m (moves sizes b c) ->
  exists n, In n (moves sizes a b) /\ to n = from m.
Proof.
  induction sizes as [|r sizes ih]; intros a b c la lb m hm; [destruct hm|].
  destruct a as [|x a]; [discriminate|]. destruct b as [|y b]; [discriminate|]. destruct c as [|z c]; [destruct hm|].
  simpl in la, lb. injection la as la. injection lb as lb. destruct hm as [e|hm].
  - subst m. exists {| size := r; from := x; to := y |}. split; [now left|reflexivity].
  - destruct (ih a b c la lb m hm) as [n [hn e]]. exists n. split; [now right|exact e].
Qed.

Lemma steps_ok os discs sizes rows : Forall (fun r => length r = length sizes) rows -> steps os discs sizes rows = true ->
  match rows with a :: _ => forall b m, In m (moves sizes a b) -> outside os (place m 0) | [] => True end ->
  all_steps (fun a b => keeps_apart os discs (moves sizes a b)) rows.
Proof.
  induction rows as [|a [|b t] ih]; intros l h start; [exact I|exact I|]. simpl in h. apply andb_true_iff in h. destruct h as [h1 h2].
  inversion l as [|? ? la l']; subst. inversion l' as [|? ? lb _]; subst.
  assert (k : keeps_apart os discs (moves sizes a b)) by (apply step_sound; [exact h1|apply start]).
  split; [exact k|]. apply ih; [exact l'|exact h2|]. intros c m hm.
  destruct (came_from sizes a b c la lb m hm) as [n [hn e]].
  destruct (k 1 ltac:(lra)) as [_ r]. destruct (r n hn) as [[r' _] _]. unfold place in *. rewrite mix_1 in r'. now rewrite mix_0, <- e.
Qed.

Lemma at_rest sizes : forall a n, In n (moves sizes a a) -> from n = to n.
Proof.
  induction sizes as [|r sizes ih]; intros [|x a] n hn; try (now destruct hn). destruct hn as [e|hn]; [now subst|now apply (ih a)].
Qed.

Theorem run_sound os discs sizes rows : run os discs sizes rows = true ->
  Forall (fun r => length r = length sizes) rows /\ all_steps (fun a b => keeps_apart os discs (moves sizes a b)) (with_start rows).
Proof.
  unfold run. intro h. apply andb_true_iff in h; destruct h as [h first]. apply andb_true_iff in h; destruct h as [l h].
  assert (l' : Forall (fun r => length r = length sizes) rows).
  { apply Forall_forall. intros r hr. rewrite forallb_forall in l. now apply PeanoNat.Nat.eqb_eq, l. }
  split; [exact l'|]. destruct rows as [|a t]; [exact I|]. inversion l' as [|? ? la _]; subst.
  apply steps_ok; [now constructor|exact h|]. intros b m hm. destruct (came_from sizes a a b la la m hm) as [n [hn e]].
  pose proof (starts_sound _ _ first) as k.
  specialize (k n hn). unfold place in *. rewrite mix_0 in *. now rewrite <- e, <- (at_rest sizes a n hn).
Qed.
