(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Answers of the small program: multipliers prove that no allowed velocity is better by more than the gap. *)
Require Import Reals QArith Qreals List Bool Lra Psatz.
From ExactVO Require Import Theorems Plane.
Import ListNotations.
Open Scope R_scope.

(* --- What a velocity must keep --- *)
Definition qabs (a : Q) : Q := qmax a (qopp a).
Definition within (x : Q) (b : option Q) : bool := match b with Some q => qle (qabs x) q | None => true end.
Definition is_slow (p : program) (v : point) : bool :=
  match disc p with Some d => qle 0 d && qle (pdot v v) (qmul d d) | None => true end
  && within (fst v) (box_x p) && within (snd v) (box_y p).
Definition is_allowed (give : Q) (p : program) (v : point) : bool :=
  is_slow p v && forallb (fun c =>
    qle (qsub (row_offset c) (if soft c then give else 0%Q)) (pdot (row_normal c) v)) (rows p).

Lemma Q2R_abs a : Q2R (qabs a) = Rabs (Q2R a).
Proof.
  unfold qabs. rewrite Q2R_max, Q2R_neg. unfold Rabs, Rmax.
  destruct (Rcase_abs (Q2R a)), (Rle_dec (Q2R a) (- Q2R a)); lra.
Qed.
Lemma within_ok x b : within x b = true -> at_most (Rabs (Q2R x)) b.
Proof. destruct b; simpl; [|auto]. intro h. apply qle_R in h. now rewrite Q2R_abs in h. Qed.
Lemma is_slow_ok p v : is_slow p v = true -> slow p (real v).
Proof.
  unfold is_slow, slow. intro h. apply andb_true_iff in h; destruct h as [h y]. apply andb_true_iff in h; destruct h as [d x].
  apply within_ok in x, y. repeat split; auto. destruct (disc p); [|auto]. reals. now split.
Qed.
Lemma is_allowed_ok give p v : is_allowed give p v = true -> allowed (Q2R give) p (real v).
Proof.
  unfold is_allowed, allowed. intro h. apply andb_true_iff in h; destruct h as [s h]. split; [now apply is_slow_ok|].
  apply Forall_forall. intros c hc. rewrite forallb_forall in h. specialize (h c hc). reals. unfold holds.
  destruct (soft c); [assumption|]. rewrite Q2R_0 in h. assumption.
Qed.

(* --- Sums of rows with multipliers: of normals, of offsets, and of the multipliers of those that may give --- *)
Record sum := { sum_normal : point; sum_offset : Q; giving : Q }.
Fixpoint weigh (cs : list row) (ls : list Q) : sum :=
  match cs, ls with
  | c :: cs, l :: ls => let s := weigh cs ls in
      if qeq l 0 then s else
      {| sum_normal := (qadd (qmul l (fst (row_normal c))) (fst (sum_normal s)), qadd (qmul l (snd (row_normal c))) (snd (sum_normal s)));
         sum_offset := qadd (qmul l (row_offset c)) (sum_offset s);
         giving := if soft c then qadd l (giving s) else giving s |}
  | _, _ => {| sum_normal := (0, 0)%Q; sum_offset := 0%Q; giving := 0%Q |}
  end.

Lemma weigh_ok give v cs : Forall (fun c => holds (if soft c then give else 0) v c) cs -> forall ls, forallb (qle 0) ls = true ->
  let s := weigh cs ls in Q2R (sum_offset s) - give * Q2R (giving s) <= dot (real (sum_normal s)) v.
Proof.
  induction cs as [|c cs ih]; intros hc [|l ls] hl; simpl;
    try (unfold dot, real; simpl; rewrite Q2R_0; lra).
  inversion hc as [|? ? h1 h2]; subst. simpl in hl. apply andb_true_iff in hl; destruct hl as [l0 hl].
  specialize (ih h2 ls hl). simpl in ih. destruct (qeq l 0); [assumption|]. apply qle_R in l0. rewrite Q2R_0 in l0. unfold holds in h1.
  assert (e : dot (real (qadd (qmul l (fst (row_normal c))) (fst (sum_normal (weigh cs ls))), qadd (qmul l (snd (row_normal c))) (snd (sum_normal (weigh cs ls))))) v
    = Q2R l * dot (real (row_normal c)) v + dot (real (sum_normal (weigh cs ls))) v).
  { unfold dot, real; simpl. rewrite !Q2R_add, !Q2R_mul. ring. }
  simpl sum_normal. rewrite e. simpl sum_offset. rewrite Q2R_add, Q2R_mul.
  destruct (soft c); simpl giving; rewrite ?Q2R_add; nra.
Qed.

(* --- How far the speed bound lets velocities reach along w --- *)
Definition below (strict : bool) (a b : Q) : bool := if strict then qlt a b else qle a b.
Definition in_box (w : Q) (b : option Q) : option Q :=
  if qeq w 0 then Some 0%Q else match b with Some q => Some (qmul q (qabs w)) | None => None end.
Definition reaches_less (p : program) (w : point) (limit : Q) (strict : bool) : bool :=
  let ww := pdot w w in
  if qle ww 0 then below strict 0 limit else
  qle 0 limit && (
    match disc p with Some d => below strict (qmul (qmul d d) ww) (qmul limit limit) | None => false end ||
    match in_box (fst w) (box_x p), in_box (snd w) (box_y p) with
    | Some x, Some y => below strict (qadd x y) limit | _, _ => false end).

Definition under (strict : bool) (a b : R) := if strict then a < b else a <= b.
Lemma below_ok s a b : below s a b = true -> under s (Q2R a) (Q2R b).
Proof. destruct s; simpl; [apply qlt_R|apply qle_R]. Qed.

Lemma in_box_ok w b q x : in_box w b = Some q -> at_most (Rabs x) b -> Q2R w * x <= Q2R q.
Proof.
  unfold in_box. destruct (qeq w 0) eqn:e.
  - intros h _. injection h as h. subst. apply qeq_R in e. rewrite e, Q2R_0. lra.
  - destruct b as [m|]; [|discriminate]. intros h hx. injection h as h. subst. rewrite Q2R_mul, Q2R_abs. simpl in hx.
    apply Rle_trans with (Rabs (Q2R w * x)); [apply Rle_abs|]. rewrite Rabs_mult, Rmult_comm. apply Rmult_le_compat_r; [apply Rabs_pos|assumption].
Qed.

Lemma reaches_less_ok p w limit s v : reaches_less p w limit s = true -> slow p v -> under s (dot (real w) v) (Q2R limit).
Proof.
  unfold reaches_less. intros h [hd [hx hy]]. destruct (qle (pdot w w) 0) eqn:z.
  - apply below_ok in h. rewrite Q2R_0 in h. reals.
    assert (dot (real w) v = 0); [|now rewrite H].
    pose proof (cauchy_schwarz (real w) v). pose proof (dot_self (real w)). assert (e : dot (real w) (real w) = 0) by lra.
    rewrite e in H. assert (dot (real w) v * dot (real w) v <= 0) by lra. nra.
  - apply andb_true_iff in h; destruct h as [l0 h]. apply qle_R in l0. rewrite Q2R_0 in l0. apply orb_true_iff in h. destruct h as [h|h].
    + destruct (disc p) as [d|]; [|discriminate]. destruct hd as [_ hd]. apply below_ok in h. rewrite !Q2R_mul, Q2R_dot in h.
      pose proof (cauchy_schwarz (real w) v) as c. pose proof (dot_self (real w)).
      assert (dot (real w) v * dot (real w) v <= Q2R d * Q2R d * dot (real w) (real w)) by nra.
      destruct s; simpl in *; [apply Rnot_le_lt; intro l; nra|apply square_le; lra].
    + destruct (in_box (fst w) (box_x p)) as [x|] eqn:ex; [|discriminate]. destruct (in_box (snd w) (box_y p)) as [y|] eqn:ey; [|discriminate].
      apply below_ok in h. rewrite Q2R_add in h. apply (in_box_ok _ _ _ (fst v)) in ex; [|assumption]. apply (in_box_ok _ _ _ (snd v)) in ey; [|assumption].
      unfold dot, real; simpl. destruct s; simpl in *; lra.
Qed.

(* --- Answers --- *)
Definition multipliers_ok (c : choice) : bool := forallb (qle 0) (pull c) && qle 0 (mu c) && forallb (qle 0) (against c).

Definition nearest (p : program) (c : choice) : bool :=
  let s := weigh (rows p) (pull c) in let w := wish p in
  let away := psub (velocity c) w in
  let pulled := (qadd (fst w) (fst (sum_normal s)), qadd (snd w) (snd (sum_normal s))) in
  match (if qeq (mu c) 0 then Some 0%Q else match disc p with Some d => Some (qmul d d) | None => None end) with
  | None => false
  | Some dd =>
      let most := qsub (qadd (pdot w w) (qmul 2 (sum_offset s))) (qmul (mu c) dd) in
      multipliers_ok c && qle 0 (gap c) && is_allowed 0 p (velocity c)
      && qle (qadd (qmul (qadd 1 (mu c)) (qsub (qsub (pdot away away) (gap c)) most)) (pdot pulled pulled)) 0
  end.

Definition farthest (p : program) (c : choice) : bool :=
  let s := weigh (rows p) (pull c) in let w := wish p in
  multipliers_ok c && qle 0 (gap c) && is_allowed 0 p (velocity c)
  && reaches_less p (qadd (fst w) (fst (sum_normal s)), qadd (snd w) (snd (sum_normal s)))
       (qadd (qadd (pdot w (velocity c)) (gap c)) (sum_offset s)) false.

Definition pinned (p : program) (v : point) : bool := is_allowed 0 p v.
Definition contradicted (p : program) (c : choice) : bool :=
  let a := weigh (rows p) (against c) in multipliers_ok c && reaches_less p (sum_normal a) (sum_offset a) true.

Definition least (p : program) (c : choice) : bool :=
  let s := weigh (rows p) (pull c) in
  let level := qmul (qsub (violation c) (gap c)) (giving s) in
  multipliers_ok c && qle 0 (gap c) && qle 0 (violation c) && is_allowed (violation c) p (velocity c) && contradicted p c
  && qlt 0 (giving s) && (qle level 0 || reaches_less p (sum_normal s) (qsub (sum_offset s) level) false).

Theorem nearest_sound p c : nearest p c = true -> is_nearest p c.
Proof.
  unfold nearest. set (s := weigh (rows p) (pull c)). intro h.
  destruct (if qeq (mu c) 0 then _ else _) as [dd|] eqn:hd; [|discriminate].
  apply andb_true_iff in h; destruct h as [h bound]. apply andb_true_iff in h; destruct h as [h ok]. apply andb_true_iff in h; destruct h as [h _].
  unfold multipliers_ok in h. apply andb_true_iff in h; destruct h as [h _]. apply andb_true_iff in h; destruct h as [hp hmu].
  apply is_allowed_ok in ok. rewrite Q2R_0 in ok. split; [assumption|]. intros w [hs hr].
  pose proof (weigh_ok 0 w (rows p) hr (pull c) hp) as k. fold s in k. simpl in k.
  assert (disc_ok : Q2R (mu c) * dot w w <= Q2R (mu c) * Q2R dd).
  { apply qle_R in hmu. rewrite Q2R_0 in hmu. destruct (qeq (mu c) 0) eqn:e.
    - apply qeq_R in e. rewrite e, Q2R_0. lra.
    - destruct hs as [hs _]. destruct (disc p) as [d|]; [|discriminate]. destruct hs as [_ hs]. injection hd as hd. subst dd. rewrite Q2R_mul. now apply Rmult_le_compat_l. }
  clear hs hr hp hd ok. reals. unfold off_wish.
  set (W := real (wish p)) in *. set (V := sub (real (velocity c)) W) in *. set (N := real (sum_normal s)) in *.
  set (C := Q2R (sum_offset s)) in *. set (m := Q2R (mu c)) in *. set (g := Q2R (gap c)) in *.
  replace (real (qadd (fst (wish p)) (fst (sum_normal s)), qadd (snd (wish p)) (snd (sum_normal s)))) with (add W N) in bound
    by (unfold add, W, N, real; simpl; now rewrite !Q2R_add).
  apply Rmult_le_reg_l with (1 + m); [lra|].
  assert (square : 0 <= dot (sub (scale (1 + m) w) (add W N)) (sub (scale (1 + m) w) (add W N))) by apply dot_self.
  assert (e : dot (sub (scale (1 + m) w) (add W N)) (sub (scale (1 + m) w) (add W N))
    = (1 + m) * (dot w w + m * dot w w - 2 * dot W w - 2 * dot N w) + dot (add W N) (add W N)) by (unfold dot, sub, add, scale; simpl; ring).
  assert (f : dot (sub w W) (sub w W) = dot w w - 2 * dot W w + dot W W) by (unfold dot, sub; simpl; ring).
  rewrite f. rewrite e in square. clear e f.
  assert (low : (1 + m) * (2 * C - m * Q2R dd) <= (1 + m) * (2 * dot N w - m * dot w w)) by (apply Rmult_le_compat_l; lra).
  revert bound square low. generalize (dot V V) (dot W W) (dot (add W N) (add W N)) (dot w w) (dot W w) (dot N w). intros. lra.
Qed.

Theorem farthest_sound p c : farthest p c = true -> is_farthest p c.
Proof.
  unfold farthest. set (s := weigh (rows p) (pull c)). intro h.
  apply andb_true_iff in h; destruct h as [h bound]. apply andb_true_iff in h; destruct h as [h ok]. apply andb_true_iff in h; destruct h as [h _].
  unfold multipliers_ok in h. apply andb_true_iff in h; destruct h as [h _]. apply andb_true_iff in h; destruct h as [hp _].
  apply is_allowed_ok in ok. rewrite Q2R_0 in ok. split; [assumption|]. intros w [hs hr].
  pose proof (weigh_ok 0 w (rows p) hr (pull c) hp) as k. fold s in k. simpl in k.
  apply (reaches_less_ok _ _ _ _ w) in bound; [|assumption]. simpl in bound. reals.
  unfold dot, real in *; simpl in *. reals. lra.
Qed.

Theorem pinned_sound p v : pinned p v = true -> allowed 0 p (real v).
Proof. intro h. apply is_allowed_ok in h. now rewrite Q2R_0 in h. Qed.

Theorem contradicted_sound p c : contradicted p c = true -> forall w, ~ allowed 0 p w.
Proof.
  unfold contradicted. set (a := weigh (rows p) (against c)). intros h w [hs hr].
  apply andb_true_iff in h; destruct h as [h no]. apply andb_true_iff in h; destruct h as [_ ha].
  pose proof (weigh_ok 0 w (rows p) hr (against c) ha) as k. fold a in k. simpl in k.
  apply (reaches_less_ok _ _ _ _ w) in no; [|assumption]. simpl in no. lra.
Qed.

Theorem least_sound p c : least p c = true -> gives_least p c.
Proof.
  unfold least. set (s := weigh (rows p) (pull c)). intro h.
  apply andb_true_iff in h; destruct h as [h level]. apply andb_true_iff in h; destruct h as [h g0]. apply andb_true_iff in h; destruct h as [h no].
  apply andb_true_iff in h; destruct h as [h ok]. apply andb_true_iff in h; destruct h as [h _]. apply andb_true_iff in h; destruct h as [h _].
  unfold multipliers_ok in h. apply andb_true_iff in h; destruct h as [h _]. apply andb_true_iff in h; destruct h as [hp _].
  assert (none := contradicted_sound p c no).
  split; [now apply is_allowed_ok|]. split; [exact none|]. intros w give [hs hr].
  destruct (Rlt_or_le give 0) as [neg|pos].
  { exfalso. apply (none w). split; [assumption|]. apply Forall_impl with (2 := hr). intros r hr'. unfold holds in *. destruct (soft r); lra. }
  pose proof (weigh_ok give w (rows p) hr (pull c) hp) as k. fold s in k. simpl in k.
  apply qlt_R in g0. rewrite Q2R_0 in g0. apply orb_true_iff in level. apply Rmult_le_reg_r with (Q2R (giving s)); [assumption|].
  destruct level as [l|l].
  - reals. nra.
  - apply (reaches_less_ok _ _ _ _ w) in l; [|assumption]. simpl in l. reals. lra.
Qed.
